// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/program.h"
#include "tests/support/shared_data.h"
#include "tests/support/test_plugins.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using testing::Handstand;
using ::testing::HasSubstr;
using testing::RunProgram;
using ::testing::SizeIs;
using testing::SourcePath;

nlohmann::json InfoOf(const std::string& file) {
  const auto run = RunProgram({"info", file, "--json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return nlohmann::json::parse(run.out);
}

TEST(Info, Recording) {
  const auto json = InfoOf(Handstand());
  EXPECT_EQ(json["kind"], "recording");
  EXPECT_EQ(json["format"], "C3D");
  EXPECT_EQ(json["frames"], 675);
  EXPECT_EQ(json["rate_hz"], 100);
  EXPECT_EQ(json["first_frame"], 1);
  EXPECT_EQ(json["unit"], "mm");
  EXPECT_EQ(json["up_axis"], "+z");
  ASSERT_THAT(json["labels"], SizeIs(53));
  for (const auto& label : json["labels"]) {
    EXPECT_EQ(label["frames_seen"], 675);
    EXPECT_THAT(label["mean_position_m"], SizeIs(3));
  }
  const auto run = RunProgram({"info", Handstand()});
  EXPECT_THAT(run.out,
              AllOf(HasSubstr("675 at 100 Hz"), HasSubstr("labels     53"), HasSubstr("C7")));
}

TEST(Info, Model) {
  const auto json = InfoOf(SourcePath("xml_config/models/mmm.xml"));
  EXPECT_EQ(json["kind"], "model");
  EXPECT_NEAR(json["mass_kg"], 1, 1e-9);  // of the reference model; sums of 19 written figures
  EXPECT_THAT(json["markers"], SizeIs(53));
  const auto& joints = json["joints"];
  const auto knee = std::find_if(joints.begin(), joints.end(),
                                 [](const auto& joint) { return joint["name"] == "LKx_joint"; });
  ASSERT_NE(knee, joints.end());
  EXPECT_NEAR((*knee)["lower_rad"], -2.26893, 1e-9);
  EXPECT_EQ((*knee)["upper_rad"], 0);
  EXPECT_THAT(RunProgram({"info", SourcePath("xml_config/models/mmm.xml")}).out,
              AllOf(HasSubstr("LKx_joint"), HasSubstr("MARKER_C7"), HasSubstr("mass")));
}

TEST(Info, Motion) {
  const auto json = InfoOf(SourcePath("examples/handstand_true.xml"));
  EXPECT_EQ(json["kind"], "motion");
  ASSERT_THAT(json["motions"], SizeIs(1));
  const auto& motion = json["motions"][0];
  EXPECT_EQ(motion["frames"], 675);
  EXPECT_GE(motion["joints"].size(), 40u);
}

TEST(Info, ConfigurationAndPlugin) {
  const auto config = InfoOf(SourcePath("xml_config/converters/s2kf_paper.xml"));
  EXPECT_EQ(config["kind"], "configuration");
  EXPECT_EQ(config["converter"], "S2KFConverter");
  EXPECT_THAT(config["elements"], ElementsAre("Filter", "MotionModel", "Noise", "Start"));
  const auto plugin = InfoOf(testing::TestPlugin("test_converter"));
  EXPECT_EQ(plugin["kind"], "plugin");
  EXPECT_EQ(plugin["name"], "TestConverter");
  EXPECT_EQ(plugin["version"], "MMMConverterS2KF-3");
}

TEST(Info, RealFiles) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const auto recording = InfoOf(testing::SharedData("recordings/whole_body/85_02.c3d"));
  EXPECT_EQ(recording["rate_hz"], 120);
  const auto motions =
      InfoOf(testing::SharedData("mmm/kit_bimanual_10hz/"
                                 "Peel_files_motions_3109_Peel1_cucumber_cb_07.xml"));
  EXPECT_GT(motions["motions"].size(), 1u);
}

TEST(Info, OtherFilesAreRefused) {
  const auto missing = RunProgram({"info", "/no/such/file"});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.err, HasSubstr("/no/such/file"));
  testing::WriteText(testing::TestFolder() + "/page.xml", "<html/>");
  const auto page = RunProgram({"info", testing::TestFolder() + "/page.xml"});
  EXPECT_EQ(page.exit_code, 1);
  EXPECT_THAT(page.err, HasSubstr("is an XML file of <html>"));
  EXPECT_EQ(RunProgram({"info", SourcePath("LICENSE")}).exit_code, 1);
  EXPECT_EQ(page.out, "");
}

}  // namespace
}  // namespace mmm_converter
