// SPDX-License-Identifier: MIT
#include "common/model/forward_kinematics.h"

#include <cassert>

#include "common/support/error.h"

namespace mmm_converter {

std::vector<Eigen::Isometry3d> SegmentPoses(const KinematicModel& model, const Posture& posture) {
  assert(posture.joint_angles.size() == model.num_joints());
  std::vector<Eigen::Isometry3d> X_WS;
  X_WS.reserve(model.segments().size());
  X_WS.push_back(Eigen::Translation3d(posture.position) * posture.orientation);
  for (std::size_t i = 1; i < model.segments().size(); ++i) {
    const Segment& segment = model.segments()[i];
    Eigen::Isometry3d X = X_WS[segment.parent] * segment.X_PF;
    if (segment.joint >= 0) {
      const double value = JointValue(segment, posture.joint_angles[segment.joint]);
      if (segment.type == JointType::kSliding) {
        X.translate(value * segment.axis);
      } else {
        X.rotate(Eigen::AngleAxisd(value, segment.axis));
      }
    }
    X_WS.push_back(X);
  }
  return X_WS;
}

Eigen::Matrix3Xd MarkerPositions(const KinematicModel& model, const Posture& posture) {
  const std::vector<Eigen::Isometry3d> X_WS = SegmentPoses(model, posture);
  Eigen::Matrix3Xd p_WM(3, model.markers().size());
  for (std::size_t i = 0; i < model.markers().size(); ++i) {
    const ModelMarker& marker = model.markers()[i];
    p_WM.col(static_cast<Eigen::Index>(i)) = X_WS[marker.segment] * marker.p_SM;
  }
  return p_WM;
}

Eigen::Vector3d CenterOfMass(const KinematicModel& model, const Posture& posture) {
  const double total_mass = model.total_mass();
  if (total_mass <= 0) {
    throw Error("the model has no mass, hence no centre of mass; use a model with <Physics>");
  }
  const std::vector<Eigen::Isometry3d> X_WS = SegmentPoses(model, posture);
  Eigen::Vector3d first_moment = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < X_WS.size(); ++i) {
    const Segment& segment = model.segments()[i];
    if (segment.mass > 0) first_moment += segment.mass * (X_WS[i] * segment.p_SB);
  }
  return first_moment / total_mass;
}

}  // namespace mmm_converter
