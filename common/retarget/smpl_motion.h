// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/io/npz/smpl_model.h"
#include "common/motion/pose_trajectory.h"
#include "common/retarget/human_body.h"

namespace mmm_converter {

/// A person's motion by the rotations of SMPL's joints; W: z up.
struct SmplMotion {
  std::vector<double> betas;
  Eigen::MatrixXd poses;         ///< a column a frame: a rotation vector of each of SmplJoints()
  Eigen::Matrix3Xd translation;  ///< of the model [m]
};

/// Limbs and their ends have the directions that they have in the motion, whatever the lengths of
/// the model, whose betas are those that bring it nearest to the person's.
SmplMotion MakeSmplMotion(const KinematicModel& model, const PoseTrajectory& motion,
                          const SmplModel& smpl);

}  // namespace mmm_converter
