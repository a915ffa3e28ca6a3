// SPDX-License-Identifier: MIT
#include "common/motion/marker_synthesis.h"

#include <cassert>
#include <cmath>
#include <string>
#include <vector>

#include "common/math/seeded_random.h"
#include "common/model/forward_kinematics.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

using Eigen::Matrix3Xd;

std::string LabelOf(const ModelMarker& marker) {
  const std::string prefix = "MARKER_";
  return marker.name.rfind(prefix, 0) == 0 ? marker.name.substr(prefix.size()) : marker.name;
}

Matrix3Xd NormalMatrix(int columns, SeededRandom& random) {
  Matrix3Xd normals(3, columns);
  for (int i = 0; i < columns; ++i) {
    for (int axis = 0; axis < 3; ++axis) normals(axis, i) = random.Normal();
  }
  return normals;
}

std::vector<int> JointIndices(const KinematicModel& model, const PoseTrajectory& motion) {
  std::vector<int> indices;
  for (const std::string& name : motion.joint_names) {
    indices.push_back(model.FindJoint(name));
    if (indices.back() < 0) {
      throw Error("the motion has joint '" + name + "', which model '" + model.name() +
                  "' does not have; use the model that the motion was made for");
    }
  }
  return indices;
}

Posture WithJoints(const Posture& rest, const std::vector<int>& indices, const Posture& frame) {
  Posture posture = rest;
  posture.position = frame.position;
  posture.orientation = frame.orientation;
  for (std::size_t j = 0; j < indices.size(); ++j) {
    posture.joint_angles[indices[j]] = frame.joint_angles[static_cast<Eigen::Index>(j)];
  }
  return posture;
}

}  // namespace

Posture ModelPosture(const KinematicModel& model, const PoseTrajectory& motion, int k) {
  return WithJoints(ZeroPosture(model), JointIndices(model, motion), motion.postures[k]);
}

MarkerSequence SynthesizeMarkers(const KinematicModel& model, const PoseTrajectory& motion,
                                 const MarkerErrors& errors, std::uint64_t seed) {
  assert(errors.wobble_time_constant > 0);
  const std::vector<ModelMarker>& markers = model.markers();
  const int num_markers = static_cast<int>(markers.size());
  std::vector<std::string> labels;
  Matrix3Xd p_SM(3, num_markers);
  for (int i = 0; i < num_markers; ++i) {
    labels.push_back(LabelOf(markers[i]));
    p_SM.col(i) = markers[i].p_SM;
  }
  MarkerSequence sequence(labels, motion.num_frames(), motion.rate, motion.first_time);

  SeededRandom random(seed);
  p_SM += errors.offset * NormalMatrix(num_markers, random);
  // Exact discretisation: stationary from the first frame on, at any rate.
  const double decay = std::exp(-1 / (motion.rate * errors.wobble_time_constant));
  const double renewal = std::sqrt(1 - decay * decay);
  Matrix3Xd wobble = NormalMatrix(num_markers, random);

  const std::vector<int> joints = JointIndices(model, motion);
  const Posture rest = ZeroPosture(model);
  for (int k = 0; k < motion.num_frames(); ++k) {
    const auto X_WS = SegmentPoses(model, WithJoints(rest, joints, motion.postures[k]));
    const Matrix3Xd noise = NormalMatrix(num_markers, random);
    auto p_WM = sequence.frame(k);
    for (int i = 0; i < num_markers; ++i) {
      p_WM.col(i) = X_WS[markers[i].segment] * (p_SM.col(i) + errors.wobble * wobble.col(i)) +
                    errors.noise * noise.col(i);
    }
    wobble = decay * wobble + renewal * NormalMatrix(num_markers, random);
  }
  return sequence;
}

}  // namespace mmm_converter
