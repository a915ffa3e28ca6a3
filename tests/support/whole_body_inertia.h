// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "common/model/forward_kinematics.h"

namespace mmm_converter::testing {

/// Inertia of the whole body about its centre of mass, in W [kg m^2]: the parallel axis theorem.
inline Eigen::Matrix3d WholeBodyInertia(const KinematicModel& model, const Posture& posture) {
  const Eigen::Vector3d p_WB = CenterOfMass(model, posture);
  const std::vector<Eigen::Isometry3d> X_WS = SegmentPoses(model, posture);
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < X_WS.size(); ++i) {
    const Segment& segment = model.segments()[i];
    const Eigen::Vector3d d = X_WS[i] * segment.p_SB - p_WB;
    inertia += X_WS[i].linear() * segment.inertia * X_WS[i].linear().transpose() +
               segment.mass * (d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose());
  }
  return inertia;
}

}  // namespace mmm_converter::testing
