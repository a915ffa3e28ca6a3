// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/model/kinematic_model.h"

namespace mmm_converter {

struct AssembledFrames {
  std::vector<double> seconds;  ///< by frame, behind the first
  double distance = 0;          ///< rms over markers and these frames [m]
};

/// What OpenSim's inverse kinematics does with a frame: Simbody's Assembler follows the markers.
/// Segments that follow others, or move by functions, are held at rest, which spares it work, and
/// it knows no limits. frames: places of the model's markers [m]. The model's root floats.
AssembledFrames FollowWithAssembler(const KinematicModel& model,
                                    const std::vector<Eigen::Matrix3Xd>& frames);

}  // namespace mmm_converter
