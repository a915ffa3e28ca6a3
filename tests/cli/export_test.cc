// SPDX-License-Identifier: MIT
// The exported files, read back by strict readers, say what the motion and the recording say.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>

#include "common/io/c3d/c3d_writer.h"
#include "common/io/mmm/mmm_model.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/io/recording/recording.h"
#include "common/math/rotation.h"
#include "common/model/forward_kinematics.h"
#include "common/model/model_scaling.h"
#include "common/motion/marker_synthesis.h"
#include "tests/cli/program.h"
#include "tests/support/shared_data.h"
#include "tests/support/strict_tables.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using testing::Handstand;
using ::testing::HasSubstr;
using testing::ReadStrictCsv;
using testing::ReadStrictMot;
using testing::ReadStrictTrc;
using testing::ReadText;
using testing::RunProgram;
using testing::StrictTable;
using testing::StrictTrc;
using testing::TestFolder;
using testing::WithTestConverter;
using testing::WriteText;

constexpr double kRadians = std::numbers::pi / 180;
// One unit of the last decimal that motions, CSV, MOT and TRC have of a length, in mm.
constexpr double kLength = 1e-4;
// The same of an angle [rad].
constexpr double kAngle = 1e-8;

// Turns z up into y up.
Eigen::Matrix3d YUp() {
  return Eigen::AngleAxisd(-std::numbers::pi / 2, Eigen::Vector3d::UnitX()).toRotationMatrix();
}

struct ExportedMotion {
  PoseTrajectory trajectory;
  MarkerSequence markers;
  StrictTable csv, mot;
  StrictTrc trc;
};

// A part of the sample with all exports.
ExportedMotion Convert(const std::string& input, std::vector<std::string> more) {
  const std::string base = TestFolder() + "/" + std::filesystem::path(input).stem().string() + "_";
  std::vector<std::string> arguments = {
      "convert",      input,          "--height",     "1.8",          "--mass",
      "75",           "-o",           base + "o.xml", "--summary",    base + "o.json",
      "--export-csv", base + "o.csv", "--export-trc", base + "o.trc", "--export-mot",
      base + "o.mot"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const auto run = RunProgram(arguments);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const MmmMotion motion = ReadMmmMotionFile(base + "o.xml").motions.at(0);
  return {motion.trajectory, motion.markers, ReadStrictCsv(ReadText(base + "o.csv")),
          ReadStrictMot(ReadText(base + "o.mot")), ReadStrictTrc(ReadText(base + "o.trc"))};
}

void ExpectCsvOf(const PoseTrajectory& trajectory, const StrictTable& csv) {
  ASSERT_EQ(csv.rows.size(), trajectory.postures.size());
  for (int k = 0; k < trajectory.num_frames(); ++k) {
    const Posture& q = trajectory.postures[k];
    EXPECT_NEAR(csv.At(k, "time_s"), trajectory.time(k), 1e-9);
    const Eigen::Vector3d position(csv.At(k, "root_x_mm"), csv.At(k, "root_y_mm"),
                                   csv.At(k, "root_z_mm"));
    EXPECT_LE((position - 1e3 * q.position).cwiseAbs().maxCoeff(), kLength);
    const Eigen::Matrix3d rotation = RotationFromRpy(
        {csv.At(k, "root_roll_rad"), csv.At(k, "root_pitch_rad"), csv.At(k, "root_yaw_rad")});
    EXPECT_LE((rotation - q.orientation.toRotationMatrix()).cwiseAbs().maxCoeff(), 4 * kAngle);
    for (std::size_t j = 0; j < trajectory.joint_names.size(); ++j) {
      EXPECT_NEAR(csv.At(k, trajectory.joint_names[j] + "_rad"), q.joint_angles[j], kAngle);
    }
  }
}

void ExpectMotOf(const PoseTrajectory& trajectory, const StrictTable& mot) {
  EXPECT_EQ(mot.keys.at("inDegrees"), "yes");
  ASSERT_EQ(mot.rows.size(), trajectory.postures.size());
  ASSERT_EQ(mot.columns.size(), 7 + trajectory.joint_names.size());
  for (int k = 0; k < trajectory.num_frames(); ++k) {
    const Posture& q = trajectory.postures[k];
    EXPECT_NEAR(mot.At(k, "time"), trajectory.time(k), 1e-9);
    const Eigen::Vector3d position(mot.At(k, "root_joint_tx"), mot.At(k, "root_joint_ty"),
                                   mot.At(k, "root_joint_tz"));
    EXPECT_LE((position - YUp() * q.position).cwiseAbs().maxCoeff(), 1e-3 * kLength);
    const auto about = [&](const std::string& column, const Eigen::Vector3d& axis) {
      return Eigen::AngleAxisd(kRadians * mot.At(k, column), axis).toRotationMatrix();
    };
    const Eigen::Matrix3d rotation = about("root_joint_ry", Eigen::Vector3d::UnitY()) *
                                     about("root_joint_rz", Eigen::Vector3d::UnitZ()) *
                                     about("root_joint_rx", Eigen::Vector3d::UnitX());
    const Eigen::Matrix3d expected = YUp() * q.orientation.toRotationMatrix() * YUp().transpose();
    EXPECT_LE((rotation - expected).cwiseAbs().maxCoeff(), 4 * kAngle);
    for (std::size_t j = 0; j < trajectory.joint_names.size(); ++j) {
      EXPECT_NEAR(kRadians * mot.At(k, trajectory.joint_names[j]), q.joint_angles[j], kAngle);
    }
  }
}

// The measured markers are the motion's; the model's are those of the scaled model in its postures.
void ExpectTrcOf(const ExportedMotion& converted, const std::map<std::string, std::string>& pairs) {
  const StrictTrc& trc = converted.trc;
  const KinematicModel model = ScaleWinter(
      ReadMmmModel(testing::SourcePath("xml_config/models/mmm.xml")), {1.8, 75, std::nullopt});
  ASSERT_EQ(trc.times.size(), converted.trajectory.postures.size());
  for (int k = 0; k < converted.trajectory.num_frames(); ++k) {
    EXPECT_NEAR(trc.times[k], converted.trajectory.time(k), 1e-9);
    for (int i = 0; i < converted.markers.num_labels(); ++i) {
      const Eigen::Vector3d z = 1e3 * YUp() * converted.markers.frame(k).col(i);
      const Eigen::Vector3d written = trc.At(k, converted.markers.labels()[i]);
      EXPECT_EQ(written.hasNaN(), z.hasNaN());
      if (!z.hasNaN()) {
        EXPECT_LE((written - z).cwiseAbs().maxCoeff(), kLength);
      }
    }
    const Eigen::Matrix3Xd p_WM =
        MarkerPositions(model, ModelPosture(model, converted.trajectory, k));
    for (const auto& [label, marker] : pairs) {
      const Eigen::Vector3d p = 1e3 * YUp() * p_WM.col(model.FindMarker(marker));
      // The motion's angles are rounded; no chain of joints is longer than 20, none is 2 m away.
      EXPECT_LE((trc.At(k, label + "_model") - p).cwiseAbs().maxCoeff(),
                kLength + 20 * 2e3 * kAngle);
    }
  }
}

std::map<std::string, std::string> PairsOf(const std::string& summary) {
  std::map<std::string, std::string> pairs;
  const auto json = nlohmann::json::parse(ReadText(summary));
  for (const auto& one : json["markers"]["used"]) pairs[one["label"]] = one["marker"];
  return pairs;
}

TEST(Export, AllSayWhatTheMotionSays) {
  const ExportedMotion converted = Convert(Handstand(), {"--frames", "100:140"});
  ExpectCsvOf(converted.trajectory, converted.csv);
  ExpectMotOf(converted.trajectory, converted.mot);
  const auto pairs = PairsOf(TestFolder() + "/handstand_o.json");
  EXPECT_EQ(pairs.size(), 53u);
  EXPECT_EQ(converted.trc.labels.size(), 106u);
  ExpectTrcOf(converted, pairs);
  EXPECT_EQ(converted.trc.numbers.front(), 101);  // the capture's, which count from 1
  EXPECT_NEAR(converted.trc.times.front(), 1, 1e-9);
  EXPECT_TRUE(converted.csv.Has("sd_LKx_joint_rad"));
  EXPECT_GT(converted.csv.At(39, "sd_LKx_joint_rad"), 0);
  EXPECT_FALSE(converted.csv.Has("d_LKx_joint_rad_per_s"));  // differences would be noise
}

TEST(Export, SmoothedPosturesHaveTheirDerivatives) {
  const ExportedMotion converted = Convert(Handstand(), {"--frames", ":60", "-c", "s2kf_offline"});
  ExpectCsvOf(converted.trajectory, converted.csv);
  const StrictTable& csv = converted.csv;
  for (std::size_t k = 1; k + 1 < csv.rows.size(); ++k) {
    for (const std::string& joint : converted.trajectory.joint_names) {
      const auto q = [&](std::size_t i) { return csv.At(i, joint + "_rad"); };
      // Central differences at 100 Hz, of angles with eight decimals.
      EXPECT_NEAR(csv.At(k, "d_" + joint + "_rad_per_s"), 50 * (q(k + 1) - q(k - 1)), 110 * kAngle);
      EXPECT_NEAR(csv.At(k, "dd_" + joint + "_rad_per_s2"), 1e4 * (q(k + 1) - 2 * q(k) + q(k - 1)),
                  2.1e4 * kAngle);
    }
  }
}

TEST(Export, MarkersConvertToTheSameMotionAgain) {
  Convert(Handstand(), {"--frames", ":40"});
  std::filesystem::rename(TestFolder() + "/handstand_o.trc", TestFolder() + "/again.trc");
  std::filesystem::rename(TestFolder() + "/handstand_o.xml", TestFolder() + "/motion.xml");
  Convert(TestFolder() + "/again.trc", {});
  Convert(TestFolder() + "/motion.xml", {});
  // The motion's file has the same markers with as many decimals.
  EXPECT_EQ(ReadText(TestFolder() + "/again_o.csv"), ReadText(TestFolder() + "/motion_o.csv"));
  EXPECT_EQ(ReadText(TestFolder() + "/again_o.mot"), ReadText(TestFolder() + "/motion_o.mot"));
}

TEST(Export, GapsAndStrangeLabelsAreWritten) {
  MarkerSequence markers = ReadRecording(Handstand(), {}).markers.Slice(0, 20);
  std::vector<std::string> labels = markers.labels();
  labels[0] = "a box";
  MarkerSequence strange(labels, 20, 100, 0);
  for (int k = 0; k < 20; ++k) strange.frame(k) = markers.frame(k);
  strange.frame(5).col(3).setConstant(std::numeric_limits<double>::quiet_NaN());
  strange.frame(7).setConstant(std::numeric_limits<double>::quiet_NaN());
  const std::string file = TestFolder() + "/strange.c3d";
  WriteC3d(file, strange);
  const std::string trc_file = TestFolder() + "/o.trc";
  const auto run =
      RunProgram(WithTestConverter({"convert", file, "--height", "1.8", "-o",
                                    TestFolder() + "/o.xml", "--export-trc", trc_file}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const StrictTrc trc = ReadStrictTrc(ReadText(trc_file));
  EXPECT_EQ(trc.labels.size(), 53u + 52u);
  EXPECT_FALSE(trc.At(5, "a_box").hasNaN());
  EXPECT_TRUE(trc.At(5, labels[3]).hasNaN());
  EXPECT_FALSE(trc.At(5, labels[3] + "_model").hasNaN());
  EXPECT_TRUE(trc.markers[7].leftCols(53).hasNaN());
  EXPECT_FALSE(trc.markers[7].rightCols(52).hasNaN());
}

TEST(Export, NothingThatIsReadOrWrittenIsOverwritten) {
  const std::string input = TestFolder() + "/walk.c3d";
  const std::string motion = TestFolder() + "/walk.xml";
  const std::string link = TestFolder() + "/link.c3d";
  std::filesystem::copy_file(Handstand(), input);
  std::filesystem::create_symlink(input, link);
  WriteText(motion, "as it was");
  const auto refused = [&](const std::vector<std::string>& more, const std::string& message) {
    std::vector<std::string> arguments = {"convert",  input, "--height", "1.8",
                                          "--frames", ":10", "-o",       motion};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto run = RunProgram(WithTestConverter(arguments));
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.err, HasSubstr(message));
    EXPECT_EQ(ReadText(motion), "as it was");
    EXPECT_EQ(ReadText(input), ReadText(Handstand()));
  };
  for (const char* option : {"--export-csv", "--export-trc", "--export-mot", "--summary"}) {
    refused({option, input}, "is read, and would be lost");
    refused({option, link}, "is read, and would be lost");
    refused({option, TestFolder() + "/./walk.xml"}, "is to hold two outputs");
  }
  refused({"--export-csv", TestFolder() + "/x", "--export-mot", TestFolder() + "/x"},
          "is to hold two outputs");
  EXPECT_FALSE(std::filesystem::exists(TestFolder() + "/x"));
}

TEST(Export, APageOfSeveralRecordingsNamesThoseThatAreNotThere) {
  const std::string walk = TestFolder() + "/walk.c3d";
  const std::string wrong = TestFolder() + "/wrong.c3d";
  const std::string page = TestFolder() + "/page.html";
  std::filesystem::copy_file(Handstand(), walk);
  WriteText(wrong, "no recording");
  const auto run = RunProgram(WithTestConverter(
      {"convert", walk, wrong, "--height", "1.8", "--frames", ":10", "--report", page}));
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr(wrong));
  const std::string text = ReadText(page);
  EXPECT_THAT(text, HasSubstr("1 of 2 recordings"));
  EXPECT_THAT(text, HasSubstr("Not converted: " + wrong));
  EXPECT_THAT(text, HasSubstr(R"("verdict":")"));
}

TEST(Export, RecordingsThatDoNotBelongTogetherAreTold) {
  const std::string a = TestFolder() + "/a", b = TestFolder() + "/b";
  const MarkerSequence walk = ReadRecording(Handstand(), {}).markers.Slice(0, 30);
  MarkerSequence child = walk;
  for (int k = 0; k < child.num_frames(); ++k) child.frame(k) *= 0.55;
  for (const std::string& folder : {a, b}) {
    std::filesystem::create_directory(folder);
    WriteC3d(folder + "/walk.c3d", walk, {});
  }
  WriteC3d(b + "/child.c3d", child, {});
  const std::string page = TestFolder() + "/page.html";
  const auto run = RunProgram(WithTestConverter(
      {"convert", a + "/walk.c3d", b + "/walk.c3d", b + "/child.c3d", "--report", page}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string text = ReadText(page);
  for (const std::string said : {"a/walk and b/walk have 30 frames in common", "m tall (a/walk 1.",
                                 "are of several persons"}) {
    EXPECT_THAT(run.out, HasSubstr(said));
    EXPECT_THAT(text, HasSubstr(said));
  }
}

TEST(Export, WhatCantBeWrittenIsNamedBeforeAnythingIsWritten) {
  for (const std::string option :
       {"--export-csv", "--export-trc", "--export-mot", "--summary", "--report"}) {
    const auto run = RunProgram(
        WithTestConverter({"convert", Handstand(), "--height", "1.8", "--frames", ":10", "-o",
                           TestFolder() + "/o.xml", option, TestFolder() + "/absent/file"}));
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.err, AllOf(HasSubstr("error: "), HasSubstr("absent/file")));
    EXPECT_FALSE(std::filesystem::exists(TestFolder() + "/o.xml")) << option;
  }
}

}  // namespace
}  // namespace mmm_converter
