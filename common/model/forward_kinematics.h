// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "common/model/kinematic_model.h"
#include "common/model/posture.h"

namespace mmm_converter {

/// Poses X_WS of all segments, in the model's order. For reports, files and tests; a tracker uses
/// MarkerKinematics.
std::vector<Eigen::Isometry3d> SegmentPoses(const KinematicModel& model, const Posture& posture);

/// Positions p_WM of all model markers, 3 x markers [m].
Eigen::Matrix3Xd MarkerPositions(const KinematicModel& model, const Posture& posture);

/// Whole-body centre of mass in W [m]. Needs total_mass() > 0.
Eigen::Vector3d CenterOfMass(const KinematicModel& model, const Posture& posture);

}  // namespace mmm_converter
