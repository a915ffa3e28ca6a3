// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "common/io/mmm_model.h"
#include "common/io/mmm_motion.h"
#include "common/math/rotation.h"
#include "tests/cli/program.h"
#include "tests/support/shared_data.h"
#include "tests/support/test_plugins.h"

namespace mmm_converter {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ReadText;
using testing::RunProgram;
using testing::TestFolder;
using testing::WriteText;

const Matrix3Xd kBox = (Matrix3Xd(3, 4) << 0.00, 0.16, 0.01, -0.05,  //
                        0.02, -0.01, 0.09, 0.00,                     //
                        0.00, 0.03, 0.05, 0.12)
                           .finished();

Isometry3d PoseAt(int k) {
  const double t = 0.03 * k;
  Isometry3d X = Isometry3d::Identity();
  X.linear() = Exp(Vector3d(std::sin(t), 0.5 * std::sin(1.3 * t), 0.7 * t)).toRotationMatrix();
  X.translation() = Vector3d(0.4 + 0.2 * std::sin(t), -0.3 * t, 1 + 0.1 * std::sin(2 * t));
  return X;
}

struct ObjectOptions {
  int frames = 60;
  std::string model_path = "nowhere/box.xml";
  bool has_gaps = false;  // one marker after the other is hidden, from frame 10 on
  int first_frame = 0;    // earlier ones show nothing
};

// A <Motion> with the markers NAME_0, NAME_1, ...
std::string ObjectMotion(const std::string& name, const Matrix3Xd& body,
                         const ObjectOptions& options = {}) {
  std::string xml = fmt::format(
      "  <Motion name=\"{}\" type=\"object\"><Model path=\"{}\"/><Sensors>\n"
      "    <Sensor type=\"MoCapMarker\" version=\"1.0\"><Configuration/><Data>\n",
      name, options.model_path);
  for (int k = 0; k < options.frames; ++k) {
    xml += fmt::format("<Measurement timestep=\"{:.2f}\">", 0.01 * k);
    const Matrix3Xd p = 1e3 * (PoseAt(k) * body);
    for (int i = 0; i < body.cols() && k >= options.first_frame; ++i) {
      if (options.has_gaps && k >= 10 && i == k / 10 % body.cols()) continue;
      xml += fmt::format("<MarkerPosition name=\"{}_{}\">{:.4f} {:.4f} {:.4f}</MarkerPosition>",
                         name, i, p(0, i), p(1, i), p(2, i));
    }
    xml += "</Measurement>\n";
  }
  return xml + "    </Data></Sensor></Sensors></Motion>\n";
}

std::string WriteRecording(const std::string& motions) {
  std::string file = TestFolder() + "/recording.xml";
  WriteText(file, "<MMM version=\"2.0\">\n" + motions + "</MMM>\n");
  return file;
}

// How far two trajectories are apart once the constant transform between them is taken out.
struct Deviation {
  double millimetres = 0;  // root mean square
  double degrees = 0;      // root mean square
};

Deviation DeviationOf(const std::vector<Isometry3d>& ours, const std::vector<Isometry3d>& stored) {
  Matrix3d sum = Matrix3d::Zero();
  Vector3d place = Vector3d::Zero();
  for (std::size_t k = 0; k < ours.size(); ++k) {
    const Isometry3d between = ours[k].inverse() * stored[k];
    sum += between.linear();
    place += between.translation() / static_cast<double>(ours.size());
  }
  const Eigen::JacobiSVD<Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Matrix3d R = svd.matrixU() * svd.matrixV().transpose();
  Deviation deviation;
  for (std::size_t k = 0; k < ours.size(); ++k) {
    const Eigen::AngleAxisd turn(stored[k].linear().transpose() * ours[k].linear() * R);
    deviation.millimetres += (1e3 * (ours[k] * place - stored[k].translation())).squaredNorm();
    deviation.degrees += std::pow(turn.angle() * 180 / EIGEN_PI, 2);
  }
  const auto count = static_cast<double>(ours.size());
  return {std::sqrt(deviation.millimetres / count), std::sqrt(deviation.degrees / count)};
}

std::vector<Isometry3d> PosesOf(const MmmMotion& motion) {
  std::vector<Isometry3d> poses;
  for (const Posture& posture : motion.trajectory.postures) {
    Isometry3d X = Isometry3d::Identity();
    X.linear() = posture.orientation.toRotationMatrix();
    X.translation() = posture.position;
    poses.push_back(X);
  }
  return poses;
}

std::vector<Isometry3d> TruePoses(int begin, int end) {
  std::vector<Isometry3d> poses;
  for (int k = begin; k < end; ++k) poses.push_back(PoseAt(k));
  return poses;
}

const MmmMotion& Find(const MmmMotionFile& file, const std::string& name) {
  const MmmMotion* motion = file.Find(name);
  EXPECT_NE(motion, nullptr) << name;
  return *motion;
}

// The object moves 0.3 m/s and the filter assumes noise: what it lags behind exact markers.
constexpr double kLagMillimetres = 0.5;
constexpr double kLagDegrees = 0.3;

TEST(Objects, AllMotionsOfAFileAreConvertedInOneRun) {
  ObjectOptions gaps;
  gaps.has_gaps = true;
  const std::string input =
      WriteRecording(ObjectMotion("box", kBox) + ObjectMotion("bag", kBox, gaps) +
                     ObjectMotion("tag", kBox.leftCols(3)) +
                     "<Motion name=\"shelf\" type=\"object\"><Sensors/></Motion>\n");
  const std::string output = TestFolder() + "/out.xml";
  const std::string summary = TestFolder() + "/out.json";
  const auto run = RunProgram({"convert", input, "--motion", "all", "-o", output, "--summary",
                               summary, "--report", TestFolder() + "/out.html"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("box"), HasSubstr("built from 60 frames"),
                             HasSubstr("shelf  has no markers; left as it is"),
                             HasSubstr("written to " + output)));
  const MmmMotionFile file = ReadMmmMotionFile(output);
  for (const char* name : {"box", "bag", "tag"}) {
    const MmmMotion& motion = Find(file, name);
    EXPECT_EQ(motion.model_path, fmt::format("out_objects/{}.xml", name));
    EXPECT_FALSE(motion.height.has_value());
    EXPECT_TRUE(std::filesystem::exists(TestFolder() + "/" + motion.model_path));
    const Deviation deviation = DeviationOf(PosesOf(motion), TruePoses(0, 60));
    EXPECT_LT(deviation.millimetres, kLagMillimetres) << name;
    EXPECT_LT(deviation.degrees, kLagDegrees) << name;
  }
  const auto json = nlohmann::json::parse(ReadText(summary));
  ASSERT_EQ(json["motions"].size(), 4);
  EXPECT_EQ(json["motions"][0]["name"], "box");
  EXPECT_EQ(json["motions"][0]["summary"]["object"]["model_is_new"], true);
  EXPECT_TRUE(json["motions"][3]["summary"].is_null());
}

TEST(Objects, EveryConverterTracksThem) {
  const std::string input = WriteRecording(ObjectMotion("tag", kBox.leftCols(3)));
  for (const char* config :
       {"s2kf_paper", "s2kf_offline", "ukf", "ekf", "jacobian_least_squares", "jacobian_pull"}) {
    const std::string output = TestFolder() + "/" + config + ".xml";
    const auto run = RunProgram({"convert", input, "--motion", "tag", "-c", config, "-o", output});
    EXPECT_EQ(run.exit_code, 0) << config << run.err;
    EXPECT_THAT(run.out, HasSubstr("0 joints tracked"));
    std::vector<Isometry3d> poses = PosesOf(Find(ReadMmmMotionFile(output), "tag"));
    poses.erase(poses.begin(), poses.begin() + 20);  // the paper's filter starts at zero
    const Deviation deviation = DeviationOf(poses, TruePoses(20, 60));
    // The paper's noise is for motions of persons, and lags more.
    EXPECT_LT(deviation.millimetres, 10) << config;
    EXPECT_LT(deviation.degrees, 5) << config;
  }
}

TEST(Objects, AModelOfAnEarlierRecordingIsUsedAgain) {
  const std::string models = TestFolder() + "/models";
  const auto convert = [&](const ObjectOptions& options, const std::string& output) {
    const auto run = RunProgram({"convert", WriteRecording(ObjectMotion("box", kBox, options)),
                                 "--motion", "box", "--object-models", models, "-o", output});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run.out;
  };
  EXPECT_THAT(convert({}, TestFolder() + "/a.xml"), HasSubstr("built from 60 frames"));
  const std::string model = ReadText(models + "/box.xml");
  const auto first = ReadText(TestFolder() + "/a.xml");
  EXPECT_THAT(convert({}, TestFolder() + "/b.xml"), HasSubstr("model in " + models));
  EXPECT_EQ(ReadText(TestFolder() + "/b.xml"), first);  // what is written is what was tracked
  ObjectOptions later;
  later.first_frame = 30;
  convert(later, TestFolder() + "/c.xml");
  EXPECT_EQ(ReadText(models + "/box.xml"), model);
  // The same frame in both recordings: no transform is taken out.
  const std::vector<Isometry3d> a =
      PosesOf(Find(ReadMmmMotionFile(TestFolder() + "/a.xml"), "box"));
  const std::vector<Isometry3d> c =
      PosesOf(Find(ReadMmmMotionFile(TestFolder() + "/c.xml"), "box"));
  EXPECT_LT((a.back().translation() - c.back().translation()).norm(), 1e-3 * kLagMillimetres);
  EXPECT_TRUE(a.back().linear().isApprox(c.back().linear(), kLagDegrees * EIGEN_PI / 180));
}

TEST(Objects, TheModelThatTheMotionNamesIsTakenWhereItIsThere) {
  ObjectOptions options;
  options.model_path = "named.xml";
  WriteText(
      TestFolder() + "/named.xml",
      "<Robot Type=\"box\" RootNode=\"r\"><RobotNode name=\"r\">"
      "<Sensor type=\"position\" name=\"box_0\"><Transform><Translation x=\"0\" y=\"20\" z=\"0\"/>"
      "</Transform></Sensor>"
      "<Sensor type=\"position\" name=\"box_1\"><Transform><Translation x=\"160\" y=\"-10\" "
      "z=\"30\"/>"
      "</Transform></Sensor>"
      "<Sensor type=\"position\" name=\"box_2\"><Transform><Translation x=\"10\" y=\"90\" "
      "z=\"50\"/>"
      "</Transform></Sensor></RobotNode></Robot>\n");
  const std::string input = WriteRecording(ObjectMotion("box", kBox, options));
  const std::string output = TestFolder() + "/out.xml";
  const auto run = RunProgram({"convert", input, "--motion", "all", "-o", output});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("model named by the motion"));
  EXPECT_FALSE(std::filesystem::exists(TestFolder() + "/out_objects"));
  const MmmMotionFile file = ReadMmmMotionFile(output);
  const Posture& last = Find(file, "box").trajectory.postures.back();
  EXPECT_LT((last.position - PoseAt(59).translation()).norm(), 1e-3 * 3 * kLagMillimetres);
}

TEST(Objects, AMotionThatFailsIsNamedAndTheOthersAreConverted) {
  const Matrix3Xd line = (Matrix3Xd(3, 4) << 0, 0.1, 0.25, 0.3, 0, 0, 0, 0, 0, 0, 0, 0).finished();
  const std::string input =
      WriteRecording(ObjectMotion("rod", line) + ObjectMotion("pair", kBox.leftCols(2)) +
                     ObjectMotion("box", kBox));
  const std::string output = TestFolder() + "/out.xml";
  const auto run = RunProgram({"convert", input, "--motion", "all", "-o", output});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, AllOf(HasSubstr("motion rod: the markers (rod_0, rod_1, rod_2, rod_3) stand "
                                       "on a line"),
                             HasSubstr("motion pair: no frame shows three of the 2 markers")));
  const MmmMotionFile file = ReadMmmMotionFile(output);
  EXPECT_EQ(Find(file, "box").trajectory.num_frames(), 60);
  EXPECT_EQ(Find(file, "rod").trajectory.num_frames(), 0);

  const std::string hopeless = WriteRecording(ObjectMotion("pair", kBox.leftCols(2)));
  const auto none =
      RunProgram({"convert", hopeless, "--motion", "all", "-o", TestFolder() + "/none.xml"});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_THAT(none.err, HasSubstr("no motion could be converted\npair: no frame shows three"));
  EXPECT_FALSE(std::filesystem::exists(TestFolder() + "/none.xml"));
}

TEST(Objects, WhatFitsOneMotionOnlyIsRefused) {
  const std::string input = WriteRecording(ObjectMotion("box", kBox));
  const auto csv =
      RunProgram({"convert", input, "--motion", "all", "--export-csv", TestFolder() + "/o.csv"});
  EXPECT_EQ(csv.exit_code, 2);
  EXPECT_THAT(csv.err, HasSubstr("--export-csv is for one motion"));
  const auto old = RunProgram({"convert", input, "--motion", "all", "--format", "1.0"});
  EXPECT_EQ(old.exit_code, 1);
  EXPECT_THAT(old.err, HasSubstr("MMM 2.0 to MMM 2.0"));
  const auto c3d = RunProgram({"convert", testing::Handstand(), "--motion", "all"});
  EXPECT_EQ(c3d.exit_code, 1);
  EXPECT_THAT(c3d.err, HasSubstr("not an MMM motion file"));
}

// Here the stored poses jump against the markers, which stay within 1 mm (rms) of one rigid shape:
// by 69 and 155 degrees for whole stretches of the lid and the spoon, whose markers are nearly on a
// line, and by 144 and 169 degrees in 1 frame of Cut and 18 of Peel for the cucumber's.
bool HasBrokenStoredPoses(const std::string& name) {
  return name == "true_apple_juice_lid" || name == "true_tablespoon" ||
         name == "true_cucumber_attachment";
}

// KIT's recordings at 10 Hz. The models of their objects are not public, so that their frames are
// unknown: one constant transform of each object is taken out.
class KitObjects : public ::testing::TestWithParam<const char*> {};

TEST_P(KitObjects, HaveTheStoredPosesUpToOneTransform) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string input = testing::SharedData("mmm/kit_bimanual_10hz/") + GetParam();
  const std::string output = TestFolder() + "/out.xml";
  const auto run = RunProgram({"convert", input, "--motion", "all", "-o", output});
  // Markers of some predicted motions are no rigid body.
  EXPECT_THAT(run.err, Not(HasSubstr("motion true_")));
  const MmmMotionFile stored = ReadMmmMotionFile(input);
  const MmmMotionFile ours = ReadMmmMotionFile(output);
  for (const MmmMotion& motion : stored.motions) {
    const MmmMotion& own = Find(ours, motion.name);
    if (motion.height || motion.markers.num_labels() == 0 || motion.trajectory.num_frames() == 0)
      continue;
    ASSERT_EQ(own.trajectory.num_frames(), motion.trajectory.num_frames()) << motion.name;
    const Deviation deviation = DeviationOf(PosesOf(own), PosesOf(motion));
    fmt::print("[ measured ] {:<28} {:6.2f} mm {:6.2f} degrees\n", motion.name,
               deviation.millimetres, deviation.degrees);
    if (motion.name.starts_with("pred_")) continue;  // markers made up by a network, not measured
    if (HasBrokenStoredPoses(motion.name)) continue;
    EXPECT_LT(deviation.millimetres, 2) << motion.name;
    EXPECT_LT(deviation.degrees, 1) << motion.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Recordings, KitObjects,
                         ::testing::Values("Close_files_motions_3072_Close1_aj_180_30h_08.xml",
                                           "Cut_files_motions_3021_Cut1_c_0_05cm_03.xml",
                                           "Peel_files_motions_3109_Peel1_cucumber_cb_07.xml",
                                           "Pour_files_motions_2967_Pour1_cs_ms_0_20l_04.xml",
                                           "Stir_files_motions_2941_Stir1_bc_s_right_03.xml"));

}  // namespace
}  // namespace mmm_converter
