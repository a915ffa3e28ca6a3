// SPDX-License-Identifier: MIT
#include "common/support/atomic_file.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/support/error.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class AtomicFile : public ::testing::Test {
 protected:
  std::string Path(const std::string& name) const { return folder_ / name; }

  static std::string Content(const std::string& path) {
    std::ostringstream content;
    content << std::ifstream(path, std::ios::binary).rdbuf();
    return content.str();
  }

  static std::string MessageOfWriting(const std::string& path, const std::string& content = "new") {
    try {
      WriteFileAtomically(path, content);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }

  long EntriesInFolder() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }

  const fs::path folder_ = testing::TestFolder();
};

TEST_F(AtomicFile, WritesANewFileWithAnyBytes) {
  const std::string bytes("a\0b\r\n\xFF", 6);
  WriteFileAtomically(Path("new"), bytes);
  EXPECT_EQ(Content(Path("new")), bytes);
  WriteFileAtomically(Path("new"), "");
  EXPECT_EQ(Content(Path("new")), "");
  EXPECT_EQ(EntriesInFolder(), 1);
}

TEST_F(AtomicFile, WritesWhatComesInPieces) {
  std::string expected;
  WriteFileAtomically(Path("pieces"), [&](const TextSink& sink) {
    for (int i = 0; i < 300; ++i) {
      const std::string piece(1000 * i, static_cast<char>('a' + i % 26));
      sink(piece);
      expected += piece;
    }
  });
  EXPECT_TRUE(Content(Path("pieces")) == expected);
  EXPECT_EQ(EntriesInFolder(), 1);
}

TEST_F(AtomicFile, LeavesTheOldFileWhereMakingTheContentFails) {
  WriteFileAtomically(Path("file"), "old");
  const auto fail = [](const TextSink& sink) {
    sink("half of ");
    throw Error("no more");
  };
  EXPECT_THROW(WriteFileAtomically(Path("file"), fail), Error);
  EXPECT_THROW(WriteFileAtomically(Path("new"), fail), Error);
  EXPECT_EQ(Content(Path("file")), "old");
  EXPECT_EQ(EntriesInFolder(), 1);
  ASSERT_EQ(::mkfifo(Path("pipe").c_str(), 0600), 0);
  EXPECT_THAT(MessageOfWriting(Path("pipe")), HasSubstr("nobody reads this pipe"));
}

TEST_F(AtomicFile, KeepsPermissionsAndFollowsUmask) {
  const mode_t old_mask = ::umask(027);
  WriteFileAtomically(Path("new"), "1");
  ::umask(old_mask);
  EXPECT_EQ(fs::status(Path("new")).permissions(), fs::perms(0640));
  fs::permissions(Path("new"), fs::perms(0606));
  WriteFileAtomically(Path("new"), "2");
  EXPECT_EQ(fs::status(Path("new")).permissions(), fs::perms(0606));
  EXPECT_EQ(Content(Path("new")), "2");
}

TEST_F(AtomicFile, WritesThroughSymbolicLinks) {
  fs::create_directory(Path("there"));
  WriteFileAtomically(Path("there/target"), "old");
  fs::create_symlink("there/target", Path("link"));
  fs::create_symlink("link", Path("link_to_link"));
  fs::create_symlink("there/not_yet", Path("dangling"));
  WriteFileAtomically(Path("link_to_link"), "new");
  WriteFileAtomically(Path("dangling"), "new too");
  EXPECT_TRUE(fs::is_symlink(Path("link_to_link")));
  EXPECT_TRUE(fs::is_symlink(Path("link")));
  EXPECT_EQ(Content(Path("there/target")), "new");
  EXPECT_EQ(Content(Path("there/not_yet")), "new too");
  fs::create_symlink("loop", Path("loop"));
  EXPECT_THAT(MessageOfWriting(Path("loop")), HasSubstr("loop: can't be written"));
}

TEST_F(AtomicFile, SaysWhyItCannotWrite) {
  WriteFileAtomically(Path("file"), "old");
  EXPECT_THAT(MessageOfWriting(folder_), HasSubstr("is a folder"));
  EXPECT_THAT(MessageOfWriting(Path("no/such/file")), HasSubstr("there is no folder"));
  EXPECT_THAT(MessageOfWriting(Path("file/below")), HasSubstr("can't be written: Not a directory"));
  EXPECT_THAT(MessageOfWriting(""), HasSubstr("is empty"));
  EXPECT_THAT(MessageOfWriting("/dev/full"), HasSubstr("/dev/full: can't be written: No space"));
  EXPECT_EQ(Content(Path("file")), "old");
  EXPECT_EQ(EntriesInFolder(), 1);
}

TEST_F(AtomicFile, LeavesTheOldFileWhereTheDiskIsFull) {
  WriteFileAtomically(Path("file"), "old");
  rlimit old_limit{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old_limit), 0);
  auto* const old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit = old_limit;
  limit.rlim_cur = 1000;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
  const std::string message = MessageOfWriting(Path("file"), std::string(5000, 'x'));
  setrlimit(RLIMIT_FSIZE, &old_limit);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_THAT(message, HasSubstr("file: can't be written: File too large"));
  EXPECT_EQ(Content(Path("file")), "old");
  EXPECT_EQ(EntriesInFolder(), 1);
}

TEST_F(AtomicFile, LeavesTheOldFileWhereThereIsNoPermission) {
  constexpr uid_t kNobody = 65534;
  WriteFileAtomically(Path("read_only"), "old");
  WriteFileAtomically(Path("in_read_only_folder"), "old");
  fs::permissions(Path("read_only"), fs::perms(0444));
  fs::permissions(Path("in_read_only_folder"), fs::perms(0666));
  fs::permissions(folder_, fs::perms(0555));
  const uid_t user = ::geteuid();
  ASSERT_EQ(::seteuid(user == 0 ? kNobody : user), 0);  // root may write anywhere
  const std::string read_only = MessageOfWriting(Path("read_only"));
  const std::string in_read_only_folder = MessageOfWriting(Path("in_read_only_folder"));
  ASSERT_EQ(::seteuid(user), 0);
  fs::permissions(folder_, fs::perms(0755));
  EXPECT_THAT(read_only, HasSubstr("Permission denied"));
  EXPECT_THAT(in_read_only_folder, HasSubstr("Permission denied"));
  EXPECT_EQ(Content(Path("read_only")), "old");
  EXPECT_EQ(Content(Path("in_read_only_folder")), "old");
  EXPECT_EQ(EntriesInFolder(), 2);
}

TEST_F(AtomicFile, AKilledProcessLeavesNothing) {
  const int nameless = ::open(folder_.c_str(), O_TMPFILE | O_WRONLY, 0600);
  if (nameless < 0) GTEST_SKIP() << "this file system has no files without names";
  ::close(nameless);
  WriteFileAtomically(Path("file"), "old");
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    WriteFileAtomically(Path("file"), [](const TextSink& sink) {
      sink("half");
      ::raise(SIGKILL);
    });
  }
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  EXPECT_EQ(Content(Path("file")), "old");
  EXPECT_EQ(EntriesInFolder(), 1);
}

// Where there are none, and between the name for a moment and the last one.
TEST_F(AtomicFile, WhatKilledProcessesLeftIsRemovedAndNothingElse) {
  const std::string of_the_living = Path(".mmm_converter.1.1.tmp");
  std::ofstream(Path(".mmm_converter.1.0.tmp")) << "half";
  std::ofstream(of_the_living) << "half";
  const int living = ::open(of_the_living.c_str(), O_WRONLY);
  ASSERT_EQ(::flock(living, LOCK_EX), 0);
  ASSERT_EQ(::mkfifo(Path(".mmm_converter.1.2.tmp").c_str(), 0600), 0);  // nobody waits for it
  WriteFileAtomically(Path("other"), "whole");
  EXPECT_FALSE(fs::exists(Path(".mmm_converter.1.0.tmp")));  // the next run removes it
  std::ofstream(Path(".mmm_converter.1.3.tmp")) << "half";
  WriteFileAtomically(Path("file"), [&](const TextSink& sink) {
    sink("wh");
    RemoveAbandonedFiles(folder_);  // what a process that is alive is writing stays
    sink("ole");
  });
  EXPECT_EQ(Content(Path("file")), "whole");
  EXPECT_EQ(Content(Path("other")), "whole");
  EXPECT_TRUE(fs::exists(of_the_living));
  EXPECT_EQ(EntriesInFolder(), 4);
  ::close(living);
  RemoveAbandonedFiles(folder_);
  EXPECT_EQ(EntriesInFolder(), 3);
  RemoveAbandonedFiles(Path("nowhere"));
}

TEST_F(AtomicFile, FilesTogetherReplaceNothingBeforeAllAreWhole) {
  WriteFileAtomically(Path("old"), "before");
  {
    FilesTogether files;
    WriteFileAtomically(Path("old"), "after");
    WriteFileAtomically(Path("new"), "after");
    EXPECT_EQ(Content(Path("old")), "before");
    EXPECT_FALSE(fs::exists(Path("new")));
    // One of them fails: the others are not written.
    EXPECT_THROW(WriteFileAtomically(Path("absent/new"), "after"), Error);
  }
  EXPECT_EQ(Content(Path("old")), "before");
  EXPECT_EQ(EntriesInFolder(), 1);
  {
    FilesTogether files;
    WriteFileAtomically(Path("old"), "after");
    {
      FilesTogether inner;
      WriteFileAtomically(Path("new"), "after");
      inner.Commit();
    }
    EXPECT_FALSE(fs::exists(Path("new")));
    files.Commit();
  }
  EXPECT_EQ(Content(Path("old")), "after");
  EXPECT_EQ(Content(Path("new")), "after");
  EXPECT_EQ(EntriesInFolder(), 2);
}

}  // namespace
}  // namespace mmm_converter
