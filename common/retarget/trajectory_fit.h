// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/model/kinematic_model.h"
#include "common/model/posture.h"
#include "common/retarget/robot_capsules.h"

namespace mmm_converter {

/// Where a point of a segment is to be, or where a direction of it is to point, in each frame.
struct Aim {
  int segment = 0;
  bool is_direction = false;
  Eigen::Vector3d local = Eigen::Vector3d::Zero();  ///< p_S [m], or a unit vector in S
  Eigen::Matrix3Xd target;                          ///< in W, a column a frame
  /// 1 / standard deviation of each coordinate in W [1/m, 1/rad]; 0: free.
  Eigen::Matrix3Xd weight;
};

/// A ball of a segment that stays above z = 0.
struct FloorBall {
  int segment = 0;
  Eigen::Vector3d p_S = Eigen::Vector3d::Zero();  ///< [m]
  double radius = 0;                              ///< [m]
};

/// The most likely motion of a model whose accelerations are white noise, that meets its aims as
/// their deviations say and its limits exactly: position, velocity, floor. Bodies are kept apart by
/// springs, so far as aims let them.
struct TrajectoryProblem {
  const KinematicModel* model = nullptr;
  double rate = 0;  ///< [Hz]
  int num_frames = 0;
  std::vector<Aim> aims;
  std::vector<FloorBall> balls;
  const RobotCapsules* capsules = nullptr;  ///< whose pairs are kept apart
  Eigen::VectorXd velocity_limits;          ///< of joints [rad/s, m/s]; infinity: none
  Eigen::VectorXd rest;                     ///< of joints, where nothing moves them
  std::vector<int> held;                    ///< joints that stay there
  double joint_acceleration = 45;           ///< standard deviation [rad/s^2]
  double root_acceleration = 40;            ///< [m/s^2]
  double root_turning = 100;                ///< [rad/s^2]
  double rest_deviation = 4;                ///< [rad]
};

/// Frame by frame, each from the one before, without regard of speeds: where a fit begins. first:
/// where the first frame begins.
std::vector<Posture> StartTrajectory(const TrajectoryProblem& problem, const Posture& first);

/// How often a fit goes on: at least `fewest` iterations unless nothing moves, at most `most`,
/// until no joint moves by more than `near` [rad] and, where limits count, all are met.
struct FitEffort {
  int fewest = 5;
  int most = 20;
  double near = 0.02;
  bool meets_limits = true;
};

struct FitResult {
  std::vector<Posture> postures;
  int iterations = 0;  ///< the most of a window
  /// The fit met all limits by itself, but for LimitCorrection's tolerances.
  bool has_converged = true;
};

/// By Gauss and Newton over windows of frames, each with all of its frames at once (a banded
/// Cholesky factor), with stiff springs at the limits, a little within them. What is left of them
/// is corrected (trajectory_limits.h). Linear in the number of frames.
FitResult FitTrajectory(const TrajectoryProblem& problem, std::vector<Posture> start,
                        const FitEffort& effort);

}  // namespace mmm_converter
