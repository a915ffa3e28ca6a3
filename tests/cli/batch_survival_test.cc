// SPDX-License-Identifier: MIT
// batch: killed, interrupted, on a full disk, and without its recordings.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <filesystem>
#include <map>
#include <random>
#include <vector>

#include "tests/cli/batch_manifest.h"
#include "tests/cli/program.h"
#include "tests/common/retarget/biped.h"
#include "tests/support/test_plugins.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using testing::Contents;
using ::testing::HasSubstr;
using testing::QuickConverter;
using testing::ReadText;
using testing::RunProgram;
using testing::StartedProgram;
using testing::TestFolder;
using testing::WriteManifest;
using testing::WriteText;

// More than a run gets done before it is ended, on any machine.
#if defined(__SANITIZE_ADDRESS__)
constexpr int kEntries = 35;
#else
constexpr int kEntries = 100;
#endif

std::string SurvivalOut(const std::string& name = "out") { return TestFolder() + "/" + name; }
std::string Journal() { return SurvivalOut() + "/journal.jsonl"; }

std::vector<std::string> Words(const std::string& manifest, const std::string& out) {
  return {"batch", manifest, "-o", out, "--resume", "--reports", "none", "--jobs", "2"};
}

long LinesOf(const std::string& file) {
  const std::string text = ReadText(file);
  return std::count(text.begin(), text.end(), '\n');
}

TEST(BatchSurvival, KilledTenTimesTheOutputsAreThoseOfAnUndisturbedRun) {
  WriteText(TestFolder() + "/biped.urdf", testing::BipedText({}));
  constexpr int kOnRobots = 12;  // the first ones, among which it is killed
  std::string others = "<Group robot='' lafan1='false'>";
  for (int i = kOnRobots; i < kEntries; ++i) {
    others += fmt::format("<Recording file='handstand.c3d' id='{}' frames='{}:{}'/>", i, 5 * i,
                          5 * i + 40);
  }
  const std::string manifest = WriteManifest(
      kOnRobots, "mass_kg='75' csv='true' robot='biped.urdf' lafan1='true'", others + "</Group>");
  ASSERT_EQ(RunProgram(Words(manifest, SurvivalOut("undisturbed"))).exit_code, 0);
  std::mt19937 random(6);
  for (int kill = 0; kill < 10; ++kill) {
    const long done = LinesOf(Journal());
    StartedProgram program(Words(manifest, SurvivalOut()));
    // A few entries on, at a random step of the work on the next.
    program.WaitForLines(Journal(), static_cast<int>(done + random() % 3));
    std::atomic<unsigned> steps = random() % 3000000;  // up to some hundredths of a second
    while (steps-- > 0) continue;
    program.Send(SIGKILL);
    EXPECT_EQ(program.Wait(), -SIGKILL);
  }
  EXPECT_LT(LinesOf(Journal()), kEntries);
  const auto run = RunProgram(Words(manifest, SurvivalOut()));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("unchanged"));
  EXPECT_EQ(Contents(SurvivalOut() + "/motions"),
            Contents(SurvivalOut("undisturbed") + "/motions"));
  for (const char* folder : {"/csv", "/robots", "/lafan1"}) {
    EXPECT_EQ(Contents(SurvivalOut() + folder), Contents(SurvivalOut("undisturbed") + folder));
    EXPECT_GE(Contents(SurvivalOut() + folder).size(), static_cast<std::size_t>(kOnRobots));
  }
  EXPECT_EQ(LinesOf(Journal()), kEntries);
}

// One recording's converter ends the process. The run after it goes on, says which it was, and does
// not try it again unasked.
TEST(BatchSurvival, ResumeGoesOnAfterARecordingThatEndsTheProcess) {
  const std::map<std::string, std::string> endings = {{"stack", "segmentation fault"},
                                                      {"creation", "it was aborted"},
                                                      {"exit", "exit() was called"}};
  const std::string manifest = WriteManifest(
      3, QuickConverter(),
      fmt::format("<Recording file='handstand.c3d' id='bad' frames=':40' plugin='{}'/>",
                  testing::TestPlugin("faulty_converter")));
  for (const auto& [fault, ending] : endings) {
    SCOPED_TRACE(fault);
    const std::map<std::string, std::string> environment = {{"MMM_CONVERTER_TEST_FAULT", fault}};
    const auto words = [&, out = SurvivalOut(fault)](const std::string& more) {
      std::vector<std::string> all = Words(manifest, out);
      if (!more.empty()) all.push_back(more);
      return all;
    };
    const std::string why = "bad: the process ended while it ran: " + ending;
    const auto crashed = RunProgram(words(""), environment);
    EXPECT_NE(crashed.exit_code, 0);
    EXPECT_THAT(crashed.err, HasSubstr(why + "; --resume goes on after it"));
    const auto resumed = RunProgram(words(""), environment);
    EXPECT_EQ(resumed.exit_code, 1);
    EXPECT_THAT(resumed.err, HasSubstr(why + ", in an earlier run; --retry-crashed"));
    EXPECT_THAT(resumed.out, HasSubstr("4 recordings, 3 converted, 1 failed, 0 missing"));
    EXPECT_THAT(ReadText(SurvivalOut(fault) + "/results.jsonl"), HasSubstr(ending));
    const auto retried = RunProgram(words("--retry-crashed"));
    EXPECT_EQ(retried.exit_code, 0) << retried.err;
    EXPECT_THAT(retried.out, HasSubstr("4 recordings, 4 converted, 0 failed, 0 missing"));
  }
}

TEST(BatchSurvival, ARecordingThatEndedTheProcessIsTriedAgainWhenItHasChanged) {
  const std::string plugin = testing::TestPlugin("faulty_converter");
  const std::string manifest = WriteManifest(1, "config='' plugin='" + plugin + "'");
  const std::map<std::string, std::string> environment = {{"MMM_CONVERTER_TEST_FAULT", "abort"}};
  EXPECT_NE(RunProgram(Words(manifest, SurvivalOut()), environment).exit_code, 0);
  EXPECT_THAT(RunProgram(Words(manifest, SurvivalOut())).err, HasSubstr("in an earlier run"));
  WriteText(TestFolder() + "/handstand.c3d", ReadText(testing::Handstand()) + "1");
  const auto run = RunProgram(Words(manifest, SurvivalOut()));
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

TEST(BatchSurvival, InterruptedItEndsInOrder) {
  const std::string manifest = WriteManifest(kEntries, "mass_kg='75'");
  for (const int signal : {SIGINT, SIGTERM}) {
    const long done = LinesOf(Journal());
    StartedProgram program(Words(manifest, SurvivalOut()));
    program.WaitForLines(Journal(), static_cast<int>(done) + 2);
    program.Send(signal);
    EXPECT_EQ(program.Wait(), 128 + signal);
    EXPECT_THAT(program.Said(),
                AllOf(HasSubstr("go on with --resume"), HasSubstr(" not done in ")));
    const auto motions = Contents(SurvivalOut() + "/motions");
    EXPECT_EQ(static_cast<long>(motions.size()), LinesOf(Journal()));
    EXPECT_FALSE(fs::exists(SurvivalOut() + "/index.html"));
  }
  const auto run = RunProgram(Words(manifest, SurvivalOut()));
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(Contents(SurvivalOut() + "/motions").size(), static_cast<std::size_t>(kEntries));
}

TEST(BatchSurvival, OneRunAtATimeHasAFolder) {
  const std::string manifest = WriteManifest(kEntries, "");
  StartedProgram program(Words(manifest, SurvivalOut()));
  program.WaitForLines(Journal(), 1);
  const auto run = RunProgram(Words(manifest, SurvivalOut()));
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("another process is writing to it"));
}

TEST(BatchSurvival, AFullDiskEndsTheRunAndResumeGoesOn) {
  const std::string manifest = WriteManifest(10, QuickConverter());
  const std::string undisturbed = SurvivalOut("undisturbed");
  ASSERT_EQ(RunProgram(Words(manifest, undisturbed)).exit_code, 0);
  fs::create_directories(SurvivalOut());
  if (unshare(CLONE_NEWNS) != 0 || mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
      mount("tmpfs", SurvivalOut().c_str(), "tmpfs", 0, "size=192k") != 0) {
    GTEST_SKIP() << "needs the right to mount a small disk: run as root";
  }
  const auto full = RunProgram(Words(manifest, SurvivalOut()));
  EXPECT_EQ(full.exit_code, 1);
  EXPECT_THAT(full.err,
              AllOf(HasSubstr("No space left on device"), HasSubstr("go on with --resume")));
  EXPECT_THAT(full.out, HasSubstr(" not done in "));
  const auto whole = Contents(undisturbed + "/motions");
  for (const auto& [name, text] : Contents(SurvivalOut() + "/motions"))
    EXPECT_EQ(text, whole.at(name));
  ASSERT_EQ(mount("tmpfs", SurvivalOut().c_str(), "tmpfs", MS_REMOUNT, "size=64m"), 0);
  const auto run = RunProgram(Words(manifest, SurvivalOut()));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(Contents(SurvivalOut() + "/motions"), whole);
}

TEST(BatchSurvival, RecordingsThatGoAwayAreTriedAgain) {
  std::string more;
  for (int i = 0; i < kEntries; ++i) {
    more += "<Recording file='archive/handstand.c3d' id='a" + std::to_string(i) +
            "' frames=':" + std::to_string(40 + i) + "'/>";
  }
  const std::string manifest = WriteManifest(0, "", more);
  fs::create_directories(TestFolder() + "/archive");
  fs::copy_file(testing::Handstand(), TestFolder() + "/archive/handstand.c3d");
  StartedProgram program(Words(manifest, SurvivalOut()));
  program.WaitForLines(Journal(), 3);
  fs::rename(TestFolder() + "/archive", TestFolder() + "/lost");
  EXPECT_EQ(program.Wait(), 1);
  EXPECT_THAT(ReadText(SurvivalOut() + "/results.jsonl"),
              HasSubstr("archive/handstand.c3d: can't be read"));
  fs::rename(TestFolder() + "/lost", TestFolder() + "/archive");
  const auto run = RunProgram(Words(manifest, SurvivalOut()));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr(fmt::format("{0} recordings, {0} converted, 0 failed, 0 missing",
                                             kEntries)));
}

}  // namespace
}  // namespace mmm_converter
