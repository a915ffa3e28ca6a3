// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "common/motion/pose_trajectory.h"

namespace mmm_converter {

/// First and second derivatives, at equal steps, of the quintic splines through the columns of
/// `values` (frames x channels), whose third and fourth derivatives are 0 at both ends: per s and
/// per s^2. Fewer than six frames: 0.
struct SplineDerivatives {
  Eigen::MatrixXd first, second;
};
SplineDerivatives DifferentiateSplines(const Eigen::MatrixXd& values, double rate);

/// Sets velocities and accelerations to those of the splines through root positions, quaternions
/// and joint angles. Far from the ends they are exact for polynomials of fifth degree, where
/// central differences (Differentiate) lose a hundredth of an acceleration at a twentieth of the
/// rate. For postures that are smooth.
void DifferentiateSplines(PoseTrajectory* trajectory);

}  // namespace mmm_converter
