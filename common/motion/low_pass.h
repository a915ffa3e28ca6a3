// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "common/motion/pose_trajectory.h"

namespace mmm_converter {

/// The largest cut-off that a rate leaves room for: four tenths of it, below Nyquist's half [Hz].
inline double LargestCutoff(double rate) { return 0.4 * rate; }

/// Each column of `values` (frames x channels) smoothed: the x that minimises
/// |x - y|^2 + lambda |third differences of x|^2, the discrete kin of Woltring's quintic smoothing
/// spline ("A FORTRAN package for generalized, cross-validatory spline smoothing and
/// differentiation", 1986). Between the ends it is the zero-phase Butterworth filter of third order
/// run in both directions, which lets 1/sqrt(2) of the cut-off's amplitude pass; unlike that, it
/// has no transient at the ends, and a constant acceleration goes through unchanged. 0 < cutoff <=
/// LargestCutoff(rate) [Hz]; fewer than four frames are returned as they are.
Eigen::MatrixXd LowPassed(const Eigen::MatrixXd& values, double rate, double cutoff);

/// frames x [root position 3 [m]; its quaternion x, y, z, w without jumps of the sign; joint
/// angles].
Eigen::MatrixXd ChannelsOf(const PoseTrajectory& motion);

/// The same for root position and joint angles; the root's rotation as a quaternion of continuous
/// sign, which treats all axes alike and lets a constant spin pass. Derivatives and standard
/// deviations are dropped.
PoseTrajectory LowPassed(const PoseTrajectory& motion, double cutoff);

}  // namespace mmm_converter
