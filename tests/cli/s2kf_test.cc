// SPDX-License-Identifier: MIT
// The main job: the real binary with the real converter on the shipped sample.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "common/io/c3d/c3d_writer.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/io/recording/recording.h"
#include "tests/cli/program.h"
#include "tests/support/changed_markers.h"

namespace mmm_converter {
namespace {

using testing::Handstand;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ReadText;
using testing::RunProgram;
using testing::TestFolder;
using testing::WriteText;

TEST(S2kf, ConvertsTheSample) {
  const std::string motion = TestFolder() + "/handstand.xml";
  const std::string summary = TestFolder() + "/handstand.json";
  const std::string csv = TestFolder() + "/handstand.csv";
  const auto run = RunProgram({"convert", Handstand(), "--height", "1.8", "-o", motion, "--summary",
                               summary, "--export-csv", csv});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto json = nlohmann::json::parse(ReadText(summary));
  EXPECT_EQ(json["converter"], "S2KFConverter");
  EXPECT_EQ(json["frames"], 675);
  EXPECT_EQ(json["frames_not_converged"], 0);
  // What the sample's markers sit off, as far as postures can't take it up.
  EXPECT_GT(json["distance_mm"]["mean"], 30);
  EXPECT_LT(json["distance_mm"]["mean"], 40);
  EXPECT_EQ(ReadMmmMotionFile(motion).motions.at(0).trajectory.num_frames(), 675);
  const std::string table = ReadText(csv);
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 676);
  EXPECT_THAT(table, HasSubstr("sd_LKx_joint_rad"));

  const auto again = RunProgram({"convert", Handstand(), "--height", "1.8", "-o", motion + "2"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(ReadText(motion), ReadText(motion + "2"));
}

TEST(S2kf, TheOfflinePresetSmoothsAndWritesDerivatives) {
  const std::string motion = TestFolder() + "/smooth.xml";
  const std::string summary = TestFolder() + "/smooth.json";
  const std::string csv = TestFolder() + "/smooth.csv";
  const std::string page = TestFolder() + "/smooth.html";
  const auto run = RunProgram({"convert", Handstand(), "--height", "1.8", "--frames", ":200", "-c",
                               "s2kf_offline", "--format", "1.0", "-o", motion, "--summary",
                               summary, "--export-csv", csv, "--report", page});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("chosen from the recording"));
  const auto json = nlohmann::json::parse(ReadText(summary));
  EXPECT_GT(json["process_noise_scale"], 0);
  EXPECT_LT(json["process_noise_scale"], 1);  // a calm motion
  EXPECT_GT(json["nis_over_degrees_of_freedom"], 0);
  EXPECT_THAT(ReadText(motion), Not(HasSubstr("<JointVelocity>0 0 0")));
  EXPECT_THAT(ReadText(csv), HasSubstr(",dd_LKx_joint_rad_per_s2"));
  EXPECT_THAT(ReadText(page), HasSubstr("nis-plot"));
}

TEST(S2kf, EstimatesTheHeightWhereNobodyGivesIt) {
  const std::string summary = TestFolder() + "/handstand.json";
  const auto run = RunProgram({"convert", Handstand(), "--frames", ":300", "-o",
                               TestFolder() + "/o.xml", "--summary", summary});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("estimated"));
  const auto json = nlohmann::json::parse(ReadText(summary));
  // Markers that sit 28 mm off on each axis leave the height open by some centimetres; it is 1.8 m.
  EXPECT_NEAR(json["person"]["height_m"].get<double>(), 1.8, 0.06);
  EXPECT_GT(json["person"]["height_deviation_m"], 0.01);
  EXPECT_LT(json["person"]["height_deviation_m"], 0.04);
}

TEST(S2kf, TheConfigurationSaysTheFormatAndTheCommandLineComesFirst) {
  const std::string config = TestFolder() + "/old.xml";
  WriteText(config,
            "<ConverterConfig type='S2KFConverter'><Output format='1.0'/></ConverterConfig>");
  const std::string motion = TestFolder() + "/o.xml";
  RunProgram(
      {"convert", Handstand(), "--height", "1.8", "--frames", ":5", "-c", config, "-o", motion});
  EXPECT_EQ(ReadMmmMotionFile(motion).version, "1.0");
  RunProgram({"convert", Handstand(), "--height", "1.8", "--frames", ":5", "-c", config, "-o",
              motion, "--format", "2.0"});
  EXPECT_EQ(ReadMmmMotionFile(motion).version, "2.0");
}

TEST(S2kf, NamesSwappedMarkersAndWhen) {
  MarkerSequence markers = ReadRecording(Handstand(), {}).markers.Slice(0, 250);
  const std::string file = TestFolder() + "/swapped.c3d";
  WriteC3d(file, testing::SwapMarkers(markers, "RWTS", "LWTS", 100, 200));
  const std::string summary = TestFolder() + "/swapped.json";
  const auto run = RunProgram({"convert", file, "--height", "1.8", "--frames", "50:", "-o",
                               TestFolder() + "/o.xml", "--summary", summary});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("LWTS and RWTS swapped, frames 100 to 199 (1.00 to 1.99 s)"));
  const auto json = nlohmann::json::parse(ReadText(summary));
  ASSERT_EQ(json["wrong_markers"].size(), 1u);
  const auto& incident = json["wrong_markers"][0];
  EXPECT_EQ(incident["kind"], "swapped");
  EXPECT_EQ(incident["labels"], (std::vector<std::string>{"LWTS", "RWTS"}));
  EXPECT_EQ(incident["first_frame"], 100);
  EXPECT_EQ(incident["last_frame"], 199);
}

}  // namespace
}  // namespace mmm_converter
