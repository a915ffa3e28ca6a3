// SPDX-License-Identifier: MIT
#include "tests/support/test_models.h"

#include <numeric>
#include <utility>

#include "common/math/rotation.h"
#include "tests/support/all_indices.h"

namespace mmm_converter::testing {

namespace {

Segment MakeSegment(const std::string& name, int parent, const Eigen::Vector3d& p_PF,
                    JointType type, const Eigen::Vector3d& axis, double lower, double upper) {
  Segment segment;
  segment.name = name;
  segment.parent = parent;
  segment.X_PF.translation() = p_PF;
  segment.type = type;
  segment.axis = axis.normalized();
  segment.lower = lower;
  segment.upper = upper;
  segment.mass = 1;
  segment.inertia = 0.01 * Eigen::Matrix3d::Identity();
  return segment;
}

}  // namespace

KinematicModel MakeBranchedModel() {
  using Eigen::Vector3d;
  ModelDescription d;
  d.name = "branched";
  const auto revolute = JointType::kRevolute;
  d.segments.push_back(MakeSegment("root", -1, {0, 0, 0}, JointType::kFixed, {0, 0, 1}, 0, 0));
  d.segments.push_back(MakeSegment("a_x", 0, {0, 0.1, 0.3}, revolute, {1, 0, 0}, -1, 1.5));
  d.segments.push_back(MakeSegment("a_z", 1, {0, 0, 0}, revolute, {0, 0, 1}, -0.5, 2));
  d.segments.push_back(MakeSegment("a_y", 2, {0, 0, 0}, revolute, {0, 1, 0}, 0, 2.5));
  d.segments.push_back(
      MakeSegment("a_length", 3, {0, 0, 0.25}, JointType::kPrismatic, {0, 0, 1}, 0, 0.25));
  d.segments.push_back(MakeSegment("b_y", 4, {0.02, 0, 0.2}, revolute, {0, -1, 0}, -1, 1));
  d.segments.push_back(
      MakeSegment("c_fixed", 0, {-0.2, 0, 0.1}, JointType::kFixed, {0, 0, 1}, 0, 0));
  d.segments.push_back(MakeSegment("c_oblique", 6, {0, 0.1, -0.2}, revolute, {1, 2, -1}, -2, 1));
  d.segments.push_back(MakeSegment("d_x", 7, {0.1, 0.1, 0.1}, revolute, {1, 0, 0}, -1, 1));
  d.segments[5].X_PF.linear() = RotationFromRpy({0.3, -0.2, 0.5});
  d.segments[6].X_PF.linear() = RotationFromRpy({-0.4, 0.1, 1.0});
  const std::vector<std::pair<int, Vector3d>> places = {
      {0, {0.1, 0, 0}},    {0, {-0.1, 0.05, 0}}, {0, {0, 0, 0.1}},     {3, {0, 0.05, 0.1}},
      {3, {0.05, 0, 0.2}}, {5, {0, 0.03, 0.1}},  {5, {0.04, 0, 0.15}}, {5, {-0.03, -0.02, 0.2}},
      {7, {0.05, 0.1, 0}}, {7, {0.1, -0.02, 0}}, {8, {0, 0.05, 0.1}},  {8, {0.1, 0, 0.2}}};
  for (std::size_t i = 0; i < places.size(); ++i) {
    d.markers.push_back({"M" + std::to_string(i), places[i].first, places[i].second});
  }
  return KinematicModel(std::move(d));
}

MarkerKinematics MakeFullKinematics(const KinematicModel& model) {
  std::vector<int> joints(model.num_joints());
  std::iota(joints.begin(), joints.end(), 0);
  const auto markers = AllIndices<MarkerIx>(model.markers().size());
  return {model, joints, markers};
}

Posture RandomPosture(const MarkerKinematics& kinematics, double share, std::mt19937* random) {
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  Posture posture;
  posture.position = {uniform(*random), uniform(*random), uniform(*random)};
  posture.orientation =
      Exp(6 * Eigen::Vector3d(uniform(*random), uniform(*random), uniform(*random)));
  posture.joint_angles.resize(kinematics.num_joints());
  for (int j = 0; j < kinematics.num_joints(); ++j) {
    const auto [lower, upper] = kinematics.Range(j);
    posture.joint_angles[j] = 0.5 * (lower + upper) + share * (upper - lower) * uniform(*random);
  }
  return posture;
}

}  // namespace mmm_converter::testing
