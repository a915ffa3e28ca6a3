// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/dynamics/motion_dynamics.h"
#include "common/model/kinematic_model.h"

namespace mmm_converter {

// What a motion that a body can do stays within; README.md says where each is from.
inline constexpr double kMostKinematicsError = 1e-9;    ///< Simbody's and ours [m]
inline constexpr double kMostMeanForceError = 0.05;     ///< in body weights
inline constexpr double kForceTolerance = 0.1;          ///< of a frame's force, in body weights
inline constexpr double kMostFriction = 1.0;            ///< horizontal over vertical force
inline constexpr double kMostOutsideSupport = 0.1;      ///< of the centre of pressure [m]
inline constexpr double kMostBadFrames = 0.1;           ///< share of the frames on the ground
inline constexpr double kCarryingForce = 0.5;           ///< vertical, in body weights
inline constexpr double kMostUneven = 0.1;              ///< of what carries, above or below it [m]
inline constexpr double kLeastOnGround = 0.5;           ///< [s]; with less nothing is judged
inline constexpr double kMostFallError = 0.1;           ///< in flight, relative to gravity
inline constexpr double kMostMomentumVariation = 0.15;  ///< in flight, relative
inline constexpr double kMostTorque = 5;   ///< of a joint [N m] for each kg of the body
inline constexpr double kMostNoise = 0.1;  ///< of a frame's force, rms, in body weights
inline constexpr double kNoiseForce = 10;  ///< body weights that no body has, but jumps of a motion

enum class DynamicsJudgement { kPlausible, kImplausible, kNotJudged };
const char* Name(DynamicsJudgement judgement);  ///< "plausible", "implausible", "not judged"

/// A measured figure beside what it must be.
struct DynamicsCheck {
  std::string name;
  std::string measured;
  std::string expected;
  DynamicsJudgement judgement = DynamicsJudgement::kNotJudged;
  std::string reason;  ///< why it is implausible or not judged, or what is left out; may be empty
};

/// What a joint does at most over the settled frames in which nothing below it touches the ground.
/// Where something does, the ground's force goes through the joint, and the motion does not tell
/// how much: NaN where that is in all frames.
struct JointPeak {
  std::string joint;
  double torque = 0;       ///< |.| [N m]
  double torque_time = 0;  ///< [s]
  double power = 0;        ///< |.| [W]
  double power_time = 0;   ///< [s]
  double free_share = 0;   ///< of the frames
};

struct Plausibility {
  std::vector<DynamicsCheck> checks;
  DynamicsJudgement judgement = DynamicsJudgement::kNotJudged;  ///< implausible where one check is
  std::string differentiation;   ///< why forces and torques can't be judged; empty: they can
  std::vector<JointPeak> peaks;  ///< of all joints, the largest torque first; empty as said above
  /// Joints x frames [N m]; NaN where the ground's force is in it, and where it is not settled.
  Eigen::MatrixXd torques;
  Eigen::MatrixXd powers;  ///< joints x frames [W]; the same
};

/// model: that of the dynamics. effort_limits: Robot::effort_limits; empty: no robot's.
Plausibility JudgeDynamics(const KinematicModel& model, const MotionDynamics& dynamics,
                           const Eigen::VectorXd& effort_limits = {});

/// Vertical component of the residual force in each frame, in body weights.
Eigen::VectorXd VerticalForce(const MotionDynamics& dynamics);

/// What the mean of it must be: 1, and what the centre of mass is faster upwards at the end.
double ExpectedMeanForce(const MotionDynamics& dynamics);

/// Whether any part of the body touches the ground.
bool IsOnGround(const MotionDynamics& dynamics, int frame);

/// Angular momentum's deviation in a flight relative to its mean, and to what the segments have.
double VariationOfSegments(const BallisticPhase& flight);

}  // namespace mmm_converter
