// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "common/model/kinematic_model.h"
#include "common/model/marker_kinematics.h"
#include "common/model/posture.h"

namespace mmm_converter::testing {

/// A small model with all that makes kinematics hard: joints about x, y, z, -y and an oblique axis,
/// a rotated static transform, a branch, a fixed and a prismatic node, markers on most segments.
KinematicModel MakeBranchedModel();

/// All joints and all markers of a model.
MarkerKinematics MakeFullKinematics(const KinematicModel& model);

/// Any root pose; tracked joint angles uniform in the middle `share` of their range.
Posture RandomPosture(const MarkerKinematics& kinematics, double share, std::mt19937* random);

}  // namespace mmm_converter::testing
