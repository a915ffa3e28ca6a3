// SPDX-License-Identifier: MIT
#include "common/support/output_plan.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "common/io/bytes/file_content.h"
#include "common/support/atomic_file.h"
#include "common/support/error.h"
#include "common/support/opened_files.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::TestFolder;

std::string In(const std::string& name) { return TestFolder() + "/" + name; }

std::string Made(const std::string& name) {
  std::ofstream(In(name)) << "content";
  return In(name);
}

std::string WhyRefused(const OutputPlan& plan) {
  try {
    plan.Check();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(OutputPlan, OutputsBesideTheInputsAreAllowed) {
  OutputPlan plan;
  plan.Read(Made("walk.c3d"));
  plan.Read("");
  plan.Read(In("absent.xml"));
  plan.Write(In("walk.xml"));
  plan.Write(Made("replaced.json"));
  plan.Write("");
  EXPECT_EQ(WhyRefused(plan), "");
}

TEST(OutputPlan, NoInputIsOverwrittenUnderAnyOfItsNames) {
  const std::string input = Made("walk.c3d");
  fs::create_symlink(input, In("soft"));
  fs::create_hard_link(input, In("hard"));
  for (const std::string& name :
       {input, In("./walk.c3d"),
        In("../" + fs::path(TestFolder()).filename().string() + "/walk.c3d"), In("soft"),
        In("hard")}) {
    OutputPlan plan;
    plan.Write(name);
    plan.Read(input);
    EXPECT_EQ(WhyRefused(plan), name + ": is read, and would be lost; give another file");
  }
}

TEST(OutputPlan, OnlyTheInputThatAnOutputMayReplaceIsReplaced) {
  const std::string recording = Made("recording.xml");
  const std::string model = Made("model.xml");
  OutputPlan in_place;
  in_place.Read(recording);
  in_place.Read(model);
  in_place.Rewrite(recording, recording);
  EXPECT_EQ(WhyRefused(in_place), "");
  OutputPlan of_another;
  of_another.Read(recording);
  of_another.Read(model);
  of_another.Rewrite(model, recording);
  EXPECT_THAT(WhyRefused(of_another), HasSubstr("model.xml: is read"));
}

TEST(OutputPlan, TwoOutputsAreTwoFiles) {
  fs::create_symlink(In("later.xml"), In("link_to_later"));
  for (const std::string& name : {In("later.xml"), In("./later.xml"), In("link_to_later")}) {
    OutputPlan plan;
    plan.Write(In("later.xml"));
    plan.Write(name);
    EXPECT_EQ(WhyRefused(plan), name + ": is to hold two outputs; give each its own file");
  }
}

TEST(OutputPlan, WhatIsWrittenBesideAnOutputIsNamed) {
  OutputPlan plan;
  plan.Write(In("loads.xml"));
  plan.Write(In("loads.mot"));
  plan.WriteBeside(In("loads.xml"), "<?xml");
  EXPECT_EQ(WhyRefused(plan), In("loads.xml") +
                                  ": is to hold two outputs, one of which is written beside " +
                                  In("loads.mot") + "; give each its own file");
}

TEST(OutputPlan, DevicesAreInNobodysWay) {
  OutputPlan plan;
  plan.Read("/dev/null");
  plan.Write("/dev/null");
  plan.Write("/dev/null");
  EXPECT_EQ(WhyRefused(plan), "");
}

TEST(OutputPlan, FoldersThatAreNotThereAreNamedBeforeTheWork) {
  OutputPlan plan;
  plan.Write(In("absent/walk.xml"));
  EXPECT_THAT(WhyRefused(plan), HasSubstr("absent/walk.xml"));
  OutputPlan makes_folder;
  makes_folder.WriteIntoFolder(In("absent/deeper/walk.xml"));
  EXPECT_EQ(WhyRefused(makes_folder), "");
  OutputPlan folder;
  folder.Write(TestFolder());
  EXPECT_THROW(folder.Check(), WriteError);
}

TEST(OutputPlan, WhatTheRunHasOpenedIsAnInput) {
  const std::string part = Made("part.xml");
  fs::create_symlink(part, In("link.xml"));
  OutputPlan plan;
  plan.Write(part);
  const OpenedFiles run;
  EXPECT_EQ(WhyRefused(plan), "");
  {
    const OpenedFiles of_reader;
    ReadFileStart(part, 1);  // a look
    EXPECT_THAT(of_reader.files(), ::testing::IsEmpty());
    ReadFileContent(In("link.xml"));
    EXPECT_THAT(of_reader.files(), ::testing::ElementsAre(fs::canonical(part).string()));
  }
  EXPECT_EQ(WhyRefused(plan), part + ": is read, and would be lost; give another file");
  OutputPlan handed_on;
  handed_on.Write(part);
  handed_on.Read(run.files());
  EXPECT_THAT(WhyRefused(handed_on), HasSubstr("is read"));
}

TEST(OutputPlan, WhatComesBesideAnOutputReplacesOnlyItsOwnKind) {
  OutputPlan plan;
  plan.WriteBeside(In("walk.xml"), "<Own");
  EXPECT_EQ(WhyRefused(plan), "");
  std::ofstream(In("walk.xml")) << "<Own>of an earlier run</Own>";
  EXPECT_EQ(WhyRefused(plan), "");
  std::ofstream(In("walk.xml")) << "<Other/>";
  EXPECT_THAT(WhyRefused(plan), HasSubstr("walk.xml: is there, was not written by this program"));
}

TEST(OutputPlan, NamesThatAreTooLongAndPipesWithoutReaderAreSaidBeforeTheWork) {
  OutputPlan too_long;
  too_long.Write(In(std::string(300, 'a')));
  EXPECT_THROW(too_long.Check(), WriteError);
  ASSERT_EQ(mkfifo(In("pipe").c_str(), 0600), 0);
  OutputPlan pipe;
  pipe.Write(In("pipe"));
  EXPECT_THAT(WhyRefused(pipe), HasSubstr("nobody reads this pipe"));
  const int reader = open(In("pipe").c_str(), O_RDONLY | O_NONBLOCK);
  EXPECT_EQ(WhyRefused(pipe), "");
  WriteFileAtomically(In("pipe"), "text");
  char read_bytes[8] = {};
  EXPECT_EQ(read(reader, read_bytes, sizeof(read_bytes)), 4);
  EXPECT_EQ(read(reader, read_bytes, sizeof(read_bytes)), 0);  // it was closed
  close(reader);
}

}  // namespace
}  // namespace mmm_converter
