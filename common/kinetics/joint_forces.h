// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "common/kinetics/foot_wrenches.h"
#include "common/kinetics/inverse_dynamics.h"
#include "common/model/kinematic_model.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter {

struct JointForcesOptions {
  /// [Hz] of postures and wrenches alike; 0: both are smooth as they are.
  double cutoff = 6;
  std::vector<int> holding = {};  ///< segments, each moved by a joint: see JointForces::held
};

/// Generalised forces of a motion with what plates exert on the feet. A column a frame; NaN: not
/// known, as a foot that the joint carries pushes against what no plate measures, or the frame is
/// within a period of the cut-off from an end of the motion, or the joint is locked.
struct JointForces {
  double rate = 0;        ///< [Hz]
  double first_time = 0;  ///< [s]
  double cutoff = 0;      ///< that was used [Hz]
  double mass = 0;        ///< of the model [kg]
  double height = 0;      ///< of the centre of mass above where the lowest foot is, mean [m]
  /// Of the model's coordinates, else of its joints.
  std::vector<std::string> names;
  std::vector<bool> is_moment;  ///< by name; false: a force
  std::vector<bool> is_of_leg;  ///< by name: a joint between the root and a foot
  Eigen::MatrixXd forces;       ///< names x frames [N m, N]
  /// Standard deviations of these; empty: not estimated (EstimateDeviations).
  Eigen::MatrixXd deviations;
  /// Of each segment that was asked for, the whole moment by which its joint holds it, also about
  /// axes about which it can't turn, about its origin (W) [N m]; NaN as in forces.
  std::vector<Eigen::Matrix3Xd> held;
  /// What the root would still need, as force (W) [N] and moment about its origin (W) [N m].
  Eigen::MatrixXd residuals;  ///< 6 x frames
  /// In which more than a quarter of the weight was carried by feet without plates that had been
  /// taken for lifted: these are not known there.
  int unmeasured_frames = 0;
  Eigen::Matrix3Xd external;  ///< sum of the plates' forces on the feet (W) [N]

  int num_frames() const { return static_cast<int>(forces.cols()); }
  double time(int k) const { return first_time + k / rate; }
};

/// All joints of the model, low-passed (cutoff [Hz]; 0: not), with derivatives.
PoseTrajectory SmoothMotion(const KinematicModel& model, const PoseTrajectory& motion,
                            double cutoff);

/// The left foot's, then the right foot's.
std::vector<BodyWrench> WrenchesAt(int frame, const KinematicModel& model,
                                   const FootWrenches& feet);

/// Inverse dynamics of `motion`, whose model is scaled and has masses and feet (HasFeet).
/// @throws Error where the model has no mass.
JointForces ComputeJointForces(const KinematicModel& model, const PoseTrajectory& motion,
                               const Contacts& contacts, const RecordedForces& forces,
                               const JointForcesOptions& options = {});

/// Of the residual's length over the frames in which it is known.
struct ResidualSize {
  double rms = 0, peak = 0;
};

/// Limits of what a residual may be. Hicks et al. ("Is my model good enough?", 2015): 5 % of the
/// largest external force, and of the moment 1 % of that times the centre of mass's height.
inline constexpr double kMostResidualForce = 0.05;
inline constexpr double kMostResidualMoment = 0.01;

struct Residuals {
  int frames = 0;  ///< that tell them
  ResidualSize force, moment;
  std::array<ResidualSize, 6> components;
  double external = 0;                     ///< largest sum of the plates' forces [N]
  double most_force = 0, most_moment = 0;  ///< the limits
  bool is_within = false;                  ///< both peaks
};
Residuals MeasureResiduals(const JointForces& found);

}  // namespace mmm_converter
