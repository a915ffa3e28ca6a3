// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/io/mmm/mmm_motion.h"
#include "common/math/statistics.h"
#include "tests/cli/pose_deviation.h"
#include "tests/cli/program.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::Deviation;
using testing::DeviationOf;
using testing::FindMotion;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::PosesOf;
using testing::ReadText;
using testing::RunProgram;
using testing::TestFolder;

// How far each marker is from its usual place (the median) in the body's frame: root mean square,
// by frame [m]. Small where the poses move as the markers do.
VectorXd Strains(const std::vector<Isometry3d>& poses, const MarkerSequence& markers) {
  std::vector<Matrix3Xd> places;
  places.reserve(poses.size());
  for (int k = 0; k < markers.num_frames(); ++k) {
    places.emplace_back(poses[k].inverse() * Matrix3Xd(markers.frame(k)));
  }
  Matrix3Xd usual(3, markers.num_labels());
  for (int i = 0; i < usual.size(); ++i) {
    std::vector<double> values;
    values.reserve(places.size());
    for (const Matrix3Xd& place : places) values.push_back(place.reshaped()[i]);
    usual.reshaped()[i] = Median(values);
  }
  VectorXd strains(markers.num_frames());
  for (int k = 0; k < strains.size(); ++k) {
    strains[k] = (places[k] - usual).norm() / std::sqrt(usual.cols());
  }
  return strains;
}

// Whether the program says that the markers hardly tell turns about the line that they are nearly
// on.
bool IsThin(const std::string& name, const std::string& warnings) {
  const std::size_t line = warnings.find("warning: motion " + name + ":");
  if (line == std::string::npos) return false;
  const std::size_t end = warnings.find('\n', line);
  return warnings.substr(line, end - line).find("turns about that line are hardly known") !=
         std::string::npos;
}

// The direction, in the body's frame, along which the markers of a frame extend farthest.
Vector3d LongAxis(const Isometry3d& pose, const Matrix3Xd& frame) {
  const Matrix3Xd centred = frame.colwise() - frame.rowwise().mean();
  const Eigen::JacobiSVD<Matrix3Xd> svd(centred, Eigen::ComputeThinU);
  return pose.linear().transpose() * svd.matrixU().col(0);
}

// Root mean square of the angle by which a line through the body stands apart [degrees].
double AxisDeviation(const std::vector<Isometry3d>& ours, const std::vector<Isometry3d>& stored,
                     const Vector3d& axis_in_ours) {
  Vector3d axis_in_stored = Vector3d::Zero();
  for (std::size_t k = 0; k < ours.size(); ++k) {
    axis_in_stored += stored[k].linear().transpose() * (ours[k].linear() * axis_in_ours);
  }
  axis_in_stored.normalize();
  double squares = 0;
  for (std::size_t k = 0; k < ours.size(); ++k) {
    const Vector3d a = ours[k].linear() * axis_in_ours;
    const Vector3d b = stored[k].linear() * axis_in_stored;
    squares += std::pow(std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / EIGEN_PI, 2);
  }
  return std::sqrt(squares / static_cast<double>(ours.size()));
}

// KIT's recordings at 10 Hz. The models of their objects are not public, so that their frames are
// unknown: one constant transform of each object is taken out.
class RealKitObjects : public ::testing::TestWithParam<const char*> {
 protected:
  // Frames in which the stored pose is farther from the markers than ours, by more than what is
  // asked for, are wrong in the file: 1 of Cut's cucumber (by 144 degrees), 18 of Peel's (by 169).
  static constexpr double kBroken = 0.002;

  static void ExpectSame(const MmmMotion& stored, const MmmMotion& own, bool is_thin) {
    ASSERT_EQ(own.trajectory.num_frames(), stored.trajectory.num_frames());
    std::vector<Isometry3d> ours = PosesOf(own);
    std::vector<Isometry3d> theirs = PosesOf(stored);
    const VectorXd our_strains = Strains(ours, stored.markers);
    const VectorXd strains = Strains(theirs, stored.markers);
    const Vector3d axis = LongAxis(ours[0], stored.markers.frame(0));
    int kept = 0;
    for (int k = 0; k < strains.size(); ++k) {
      if (strains[k] > our_strains[k] + kBroken) continue;
      ours[kept] = ours[k];
      theirs[kept++] = theirs[k];
    }
    ours.resize(kept);
    theirs.resize(kept);
    const auto broken = strains.size() - kept;
    const Deviation deviation = DeviationOf(ours, theirs);
    const double degrees = is_thin ? AxisDeviation(ours, theirs, axis) : deviation.degrees;
    fmt::print("[ measured ] {:<26} {:5.2f} mm {:5.2f} degrees; {} broken\n", stored.name,
               deviation.millimetres, degrees, broken);
    // What KIT's stored poses are taken to be good for.
    EXPECT_LT(deviation.millimetres, 2);
    EXPECT_LT(degrees, 1);
    EXPECT_LT(broken, strains.size() / 5);
  }
};

TEST_P(RealKitObjects, HaveTheStoredPosesUpToOneTransform) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string input = testing::SharedData("mmm/kit_bimanual_10hz/") + GetParam();
  const std::string output = TestFolder() + "/out.xml";
  const auto run = RunProgram({"convert", input, "--motion", "all", "-o", output});
  // Markers of some predicted motions are no rigid body: a network made them up.
  EXPECT_THAT(run.err, Not(HasSubstr("error: motion true_")));
  const MmmMotionFile stored = ReadMmmMotionFile(input);
  const MmmMotionFile ours = ReadMmmMotionFile(output);
  int objects = 0;
  for (const MmmMotion& motion : stored.motions) {
    if (!motion.name.starts_with("true_") || motion.size.height || motion.markers.num_labels() == 0)
      continue;
    SCOPED_TRACE(motion.name);
    ExpectSame(motion, FindMotion(ours, motion.name), IsThin(motion.name, run.err));
    ++objects;
  }
  EXPECT_GE(objects, 2);
}

// Its knife is reinitialised, from where the smoothed track goes back in search of a better one.
TEST(RealKitObjectsSmoothed, ATrackTakenUpAnewIsFollowedBackwards) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string summary = TestFolder() + "/out.json";
  const auto run = RunProgram(
      {"convert",
       testing::SharedData("mmm/kit_bimanual_10hz/Cut_files_motions_3021_Cut1_c_0_05cm_03.xml"),
       "--motion", "true_knife_black", "-c", "s2kf_offline", "-o", TestFolder() + "/out.xml",
       "--summary", summary});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto json = nlohmann::json::parse(ReadText(summary));
  EXPECT_GE(json["frames_reassembled"], 1);
  // The shape is 0.5 mm from the markers; nothing that is tracked is much farther.
  EXPECT_LT(json["distance_mm"]["mean"], 1);
}

INSTANTIATE_TEST_SUITE_P(Recordings, RealKitObjects,
                         ::testing::Values("Close_files_motions_3072_Close1_aj_180_30h_08.xml",
                                           "Cut_files_motions_3021_Cut1_c_0_05cm_03.xml",
                                           "Peel_files_motions_3109_Peel1_cucumber_cb_07.xml",
                                           "Pour_files_motions_2967_Pour1_cs_ms_0_20l_04.xml",
                                           "Stir_files_motions_2941_Stir1_bc_s_right_03.xml"));

}  // namespace
}  // namespace mmm_converter
