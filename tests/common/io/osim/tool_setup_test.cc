// SPDX-License-Identifier: MIT
#include "common/io/osim/tool_setup.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "common/io/bytes/file_content.h"
#include "common/support/atomic_file.h"
#include "common/support/error.h"
#include "tests/support/shared_data.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

OsimToolSetup Parse(const std::string& tool) {
  return ParseOsimToolSetup("<OpenSimDocument Version=\"40000\">" + tool + "</OpenSimDocument>",
                            "setup.xml");
}

TEST(OsimToolSetup, OfInverseKinematics) {
  const OsimToolSetup setup = Parse(
      "<InverseKinematicsTool name='walk'><model_file> a.osim </model_file>"
      "<IKTaskSet><objects/></IKTaskSet><marker_file>walk.trc</marker_file>"
      "<coordinate_file>Unassigned</coordinate_file><time_range> 0.5 1.5</time_range>"
      "</InverseKinematicsTool>");
  EXPECT_EQ(setup.tool, "InverseKinematicsTool");
  EXPECT_EQ(setup.model_file, "a.osim");
  EXPECT_EQ(setup.marker_file, "walk.trc");
  EXPECT_TRUE(setup.has_tasks);
  ASSERT_TRUE(setup.time_range);
  EXPECT_EQ((*setup.time_range)[1], 1.5);
  EXPECT_EQ(
      Parse("<InverseKinematicsTool><IKTaskSet file='t.xml'/></InverseKinematicsTool>").tasks_file,
      "t.xml");
}

TEST(OsimToolSetup, TimesThatAreNoneAreEverythingOrAnError) {
  const auto with = [](const char* times) {
    return Parse(std::string("<InverseKinematicsTool><time_range>") + times +
                 "</time_range></InverseKinematicsTool>");
  };
  EXPECT_FALSE(with("").time_range);
  EXPECT_FALSE(with("-1 -1").time_range);
  EXPECT_TRUE(with("-Inf Inf").time_range);
  for (const char* wrong : {"1", "2 1", "a b", "1 2 3", "nan 1"}) {
    EXPECT_THAT([&] { with(wrong); }, ThrowsMessage<Error>(HasSubstr("setup.xml:1: <time_range>")))
        << wrong;
  }
}

TEST(OsimToolSetup, OtherFilesAreRefused) {
  EXPECT_FALSE(IsOsimToolSetup("<OpenSimDocument><Model/></OpenSimDocument>"));
  EXPECT_TRUE(IsOsimToolSetup("<ScaleTool/>"));
  EXPECT_THAT([] { Parse("<Model/>"); }, ThrowsMessage<Error>(HasSubstr("setup.xml:1: ")));
  EXPECT_THROW(ParseOsimToolSetup("<InverseKinematicsTool>", "setup.xml"), Error);
}

// Written on another machine, or on Windows.
TEST(OsimToolSetup, FilesAreBesideTheSetUp) {
  const testing::TemporaryFolder folder;
  const std::string setup = folder.path() + "/in/setup.xml", model = folder.path() + "/in/A.osim";
  std::filesystem::create_directories(folder.path() + "/in");
  WriteFileAtomically(model, "x");
  WriteFileAtomically(folder.path() + "/b.trc", "x");
  Warnings warnings;
  EXPECT_EQ(FindFileOfSetup(setup, "A.osim", "model", &warnings), model);
  EXPECT_EQ(FindFileOfSetup(setup, "..\\b.trc", "recording", &warnings),
            folder.path() + "/in/../b.trc");
  EXPECT_EQ(FindFileOfSetup(setup, "a.OSIM", "model", &warnings), model);
  EXPECT_TRUE(warnings.texts().empty());
  for (const char* elsewhere :
       {"C:\\OpenSim\\models\\A.osim", "/home/anna/a.osim", "models/A.osim"}) {
    warnings = Warnings();
    EXPECT_EQ(FindFileOfSetup(setup, elsewhere, "model", &warnings), model);
    ASSERT_EQ(warnings.texts().size(), 1U) << elsewhere;
    EXPECT_THAT(warnings.texts()[0], HasSubstr(elsewhere));
  }
  EXPECT_THAT([&] { FindFileOfSetup(setup, "c.osim", "model", nullptr); },
              ThrowsMessage<Error>(HasSubstr("names the model c.osim")));
}

TEST(OsimToolSetupReal, OfOpenSimsExamples) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const auto read = [](const std::string& name) {
    const std::string file = testing::SharedData("osim/" + name);
    return ParseOsimToolSetup(ReadFileContent(file), file);
  };
  const OsimToolSetup scaling = read("subject01_Setup_Scale.xml");
  EXPECT_EQ(scaling.model_file, "gait2354_simbody.osim");
  EXPECT_EQ(scaling.marker_set_file, "gait2354_Scale_MarkerSet.xml");
  EXPECT_EQ(scaling.marker_file, "subject01_static.trc");
  ASSERT_TRUE(scaling.time_range);
  const OsimToolSetup dynamics = read("inverse_dynamics/subject01_Setup_InverseDynamics.xml");
  EXPECT_EQ(dynamics.coordinates_file, "subject01_walk1_ik.mot");
  EXPECT_EQ(dynamics.loads_file, "subject01_walk1_grf.xml");
  EXPECT_EQ(dynamics.marker_file, "");
}

}  // namespace
}  // namespace mmm_converter
