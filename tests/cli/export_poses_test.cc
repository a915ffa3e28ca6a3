// SPDX-License-Identifier: MIT
// Poses of segments and BVH say what the motion says. tests/python/poses_test.py reads .npz files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "common/io/mmm/mmm_model.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/math/rotation.h"
#include "common/math/up_axis.h"
#include "common/model/forward_kinematics.h"
#include "common/model/model_scaling.h"
#include "common/motion/marker_synthesis.h"
#include "tests/cli/program.h"
#include "tests/support/shared_data.h"
#include "tests/support/strict_bvh.h"
#include "tests/support/strict_tables.h"

namespace mmm_converter {
namespace {

using ::testing::HasSubstr;
using testing::ReadStrictCsv;
using testing::ReadText;
using testing::RunProgram;
using testing::StrictTable;
using testing::TestFolder;

// The motion's angles have eight decimals and its lengths seven of a metre.
constexpr double kPoseRounding = 1e-6;

// The sample as a motion with all exports; in the test's folder.
PoseTrajectory ConvertSample(std::vector<std::string> more) {
  const std::string base = TestFolder() + "/m.";
  std::vector<std::string> arguments = {"convert",
                                        testing::Handstand(),
                                        "--height",
                                        "1.8",
                                        "--mass",
                                        "75",
                                        "--frames",
                                        "100:130",
                                        "-o",
                                        base + "xml",
                                        "--export-poses",
                                        base + "csv",
                                        "--export-bvh",
                                        base + "bvh",
                                        "--export-bvh-m",
                                        base + "metres.bvh"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const auto run = RunProgram(arguments);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return ReadMmmMotionFile(base + "xml").motions.at(0).trajectory;
}

KinematicModel SamplesModel() {
  return ScaleWinter(ReadMmmModel(testing::SourcePath("xml_config/models/mmm.xml")),
                     {1.8, 75, std::nullopt});
}

Eigen::Vector3d PlaceAt(const StrictTable& table, int row, const std::string& name) {
  return {table.At(row, name + "_x_m"), table.At(row, name + "_y_m"), table.At(row, name + "_z_m")};
}

TEST(ExportPoses, ConversionWritesThePosesOfItsMotion) {
  const PoseTrajectory motion = ConvertSample({"-c", "s2kf_offline"});
  const KinematicModel model = SamplesModel();
  const StrictTable csv = ReadStrictCsv(ReadText(TestFolder() + "/m.csv"));
  ASSERT_EQ(csv.rows.size(), 30u);
  for (int k = 0; k < 30; ++k) {
    const Posture q = ModelPosture(model, motion, k);
    const auto X_WS = SegmentPoses(model, q);
    for (std::size_t i = 0; i < X_WS.size(); ++i) {
      std::string name = model.segments()[i].name;
      std::replace(name.begin(), name.end(), ' ', '_');
      EXPECT_LT((PlaceAt(csv, k, name) - X_WS[i].translation()).norm(), kPoseRounding) << name;
      const Eigen::Quaterniond r(csv.At(k, name + "_qw"), csv.At(k, name + "_qx"),
                                 csv.At(k, name + "_qy"), csv.At(k, name + "_qz"));
      EXPECT_LT((r.toRotationMatrix() - X_WS[i].linear()).norm(), kPoseRounding) << name;
    }
    EXPECT_LT((PlaceAt(csv, k, "com") - CenterOfMass(model, q)).norm(), kPoseRounding);
    const auto point = X_WS[model.FindSegment("RMrot_joint")].translation();
    EXPECT_LT((PlaceAt(csv, k, "point_RMrot") - point).norm(), kPoseRounding);
  }
  EXPECT_TRUE(csv.Has("d_LWx_joint_about_z_rad_per_s"));
  EXPECT_TRUE(csv.Has("d_com_z_m_per_s"));
}

TEST(ExportPoses, FinishedMotionsGiveTheSame) {
  ConvertSample({});
  const StrictTable csv = ReadStrictCsv(ReadText(TestFolder() + "/m.csv"));
  EXPECT_FALSE(csv.Has("d_com_z_m_per_s"));  // differences would be noise
  const std::string again = TestFolder() + "/again.csv";
  auto run = RunProgram({"export-poses", TestFolder() + "/m.xml", "-o", again});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const StrictTable read = ReadStrictCsv(ReadText(again));
  ASSERT_EQ(read.columns, csv.columns);
  for (std::size_t k = 0; k < csv.rows.size(); ++k) {
    for (std::size_t i = 0; i < csv.columns.size(); ++i) {
      ASSERT_NEAR(read.rows[k][i], csv.rows[k][i], kPoseRounding) << csv.columns[i];
    }
  }
  run = RunProgram({"export-poses", TestFolder() + "/m.xml", "-o", again, "--segments",
                    "LWx_joint, root_joint", "--relative-to", "root", "--rotation", "vector",
                    "--points", "none", "--frames", "3:5", "--velocities"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const StrictTable few = ReadStrictCsv(ReadText(again));
  ASSERT_EQ(few.rows.size(), 2u);
  EXPECT_NEAR(few.At(0, "time_s"), 1.03, 1e-9);
  EXPECT_EQ(few.columns.size(), 1u + 2 * 6 + 3 + 2 * 6 + 3);
  EXPECT_EQ(few.At(1, "root_joint_x_m"), 0);
  EXPECT_EQ(few.At(1, "root_joint_rz_rad"), 0);
  EXPECT_EQ(few.At(1, "d_root_joint_about_x_rad_per_s"), 0);
}

TEST(ExportPoses, SeveralMotionsHaveAFileEach) {
  ConvertSample({});
  const std::string motion = TestFolder() + "/m.xml";
  std::filesystem::copy_file(motion, TestFolder() + "/n.xml");
  const auto export_both = [&](const std::string& folder) {
    const auto run = RunProgram({"export-poses", motion, TestFolder() + "/n.xml", "-o",
                                 TestFolder() + "/" + folder, "--segments", "none"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return ReadText(TestFolder() + "/" + folder + "/n.npz");
  };
  const std::string npz = export_both("poses");
  EXPECT_THAT(npz, ::testing::StartsWith("PK"));
  EXPECT_EQ(npz, ReadText(TestFolder() + "/poses/m.npz"));
  EXPECT_EQ(npz, export_both("again"));
}

TEST(ExportPoses, WhatIsNotThereIsSaid) {
  ConvertSample({});
  const std::string motion = TestFolder() + "/m.xml";
  const std::string output = TestFolder() + "/o.npz";
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& message) {
    const auto run = RunProgram(arguments);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.err, HasSubstr(message));
    EXPECT_FALSE(std::filesystem::exists(output));
  };
  refused({"export-poses", motion, "-o", output, "--segments", "LWx_jont"},
          "has no segment \"LWx_jont\" (did you mean LWx_joint?)");
  refused({"export-poses", testing::Handstand(), "-o", output}, "convert it first");
  const std::string linked = TestFolder() + "/m.csv";
  std::filesystem::remove(linked);
  std::filesystem::create_symlink(motion, linked);
  refused({"export-poses", motion, "-o", linked}, "is read, and would be lost");
}

TEST(ExportPosesRealFiles, ObjectsOfTheFileAreThere) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string file = testing::SharedData(
      "mmm/kit_bimanual_10hz/Close_files_motions_3072_Close1_aj_180_30h_08.xml");
  const std::string output = TestFolder() + "/o.csv";
  const auto run = RunProgram(
      {"export-poses", file, "--motion", "true_1723", "-o", output, "--segments", "root_joint"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const StrictTable csv = ReadStrictCsv(ReadText(output));
  const MmmMotionFile read = ReadMmmMotionFile(file);
  const PoseTrajectory& person = read.Find("true_1723")->trajectory;
  const PoseTrajectory& juice = read.Find("true_apple_juice")->trajectory;
  int compared = 0;
  for (int k = 0; k < person.num_frames(); ++k) {
    for (int j = 0; j < juice.num_frames(); ++j) {
      if (std::abs(juice.time(j) - person.time(k)) > 1e-6) continue;
      const auto place = PlaceAt(csv, k, "true_apple_juice");
      EXPECT_LT((place - juice.postures[j].position).norm(), kPoseRounding);
      ++compared;
    }
  }
  EXPECT_GT(compared, 80);
}

TEST(ExportBvh, InfoSaysWhatIsInTheFiles) {
  ConvertSample({"--export-csv", TestFolder() + "/angles.csv"});
  const std::string npz = TestFolder() + "/m.npz";
  ASSERT_EQ(RunProgram({"export-poses", TestFolder() + "/m.xml", "-o", npz}).exit_code, 0);
  const auto info = [](const std::string& file) { return RunProgram({"info", file}).out; };
  EXPECT_THAT(info(npz), HasSubstr("arrays for NumPy"));
  EXPECT_THAT(info(npz), ::testing::ContainsRegex("point_positions +<f8 \\(30, 21, 3\\)"));
  EXPECT_THAT(info(TestFolder() + "/m.bvh"), HasSubstr("frames     30"));
  EXPECT_THAT(info(TestFolder() + "/m.bvh"), HasSubstr("BVH recording"));
  EXPECT_THAT(info(TestFolder() + "/m.csv"), HasSubstr("table of poses of a body"));
  EXPECT_THAT(info(TestFolder() + "/angles.csv"), HasSubstr("table of postures"));
  // Half of a file, and an archive whose sizes are not true.
  const std::string bytes = ReadText(npz);
  testing::WriteText(npz, bytes.substr(0, bytes.size() / 2));
  EXPECT_THAT(info(npz), HasSubstr("segment_positions"));
  testing::WriteText(npz, bytes.substr(0, 18) + std::string(12, '\xff') + ".npy");
  EXPECT_THAT(info(npz), HasSubstr("arrays for NumPy"));
}

TEST(ExportBvh, JointsAreWhereTheMotionHasThem) {
  const PoseTrajectory motion = ConvertSample({});
  const KinematicModel model = SamplesModel();
  const auto bvh = testing::ReadStrictBvh(ReadText(TestFolder() + "/m.bvh"));
  const auto in_metres = testing::ReadStrictBvh(ReadText(TestFolder() + "/m.metres.bvh"));
  EXPECT_NEAR(bvh.frame_time, 0.01, 1e-12);
  ASSERT_EQ(bvh.frames.size(), 30u);
  const Eigen::Matrix3d to_z_up = RotationToZUp(UpAxis::kY);
  for (int k = 0; k < 30; ++k) {
    const auto X_WS = SegmentPoses(model, ModelPosture(model, motion, k));
    const auto places = bvh.Places(k);
    for (const auto& [joint, segment] : std::map<std::string, std::string>{
             {"Hips", "root_joint"}, {"LeftHand", "LWx_joint"}, {"RightToeBase", "RFx_joint"}}) {
      const Eigen::Vector3d place = 0.01 * to_z_up * places.at(bvh.Find(joint));
      EXPECT_LT((place - X_WS[model.FindSegment(segment)].translation()).norm(), kPoseRounding);
      const Eigen::Vector3d same = to_z_up * in_metres.Places(k).at(in_metres.Find(joint));
      EXPECT_LT((same - place).norm(), kPoseRounding);
    }
  }
}

}  // namespace
}  // namespace mmm_converter
