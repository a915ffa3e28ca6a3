// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "common/model/kinematic_model.h"
#include "common/model/posture.h"

namespace mmm_converter {

inline constexpr double kGravity = 9.81;  ///< [m/s^2]

/// What Simbody computes at one posture; all in W.
struct WholeBodyState {
  std::vector<Eigen::Isometry3d> X_WS;  ///< of all segments, in the model's order [m]
  Eigen::Matrix3Xd p_WM;                ///< of all markers, 3 x markers [m]
  double mass = 0;                      ///< of the whole body [kg]
  Eigen::Vector3d center_of_mass;       ///< of the whole body [m]; NaN where it has no mass
  Eigen::Matrix3d central_inertia;      ///< of the whole body about its centre of mass [kg m^2]
};

/// What Simbody computes from a posture, velocities and accelerations; all in W. Needs mass.
struct WholeBodyMotion {
  Eigen::Vector3d center_of_mass;           ///< [m]
  Eigen::Vector3d center_of_mass_velocity;  ///< [m/s]
  Eigen::Vector3d linear_momentum;          ///< [kg m/s]
  Eigen::Vector3d angular_momentum;         ///< about the centre of mass [kg m^2/s]
  double segment_angular_momentum = 0;      ///< sum of the segments' |L| about it [kg m^2/s]
  double kinetic_energy = 0;                ///< [J]
  /// That make the body move so, beside weight: force on the root [N], moment about its origin
  /// [N m], joint torques [N m].
  Eigen::VectorXd forces;
};

/// A KinematicModel as a Simbody multibody system: for dynamics, and as an independent check of our
/// own kinematics. The only user of Simbody; this header is C++17, as Simbody's are.
class SimbodyModel {
 public:
  /// @throws Error where the inertia of a node is impossible.
  explicit SimbodyModel(const KinematicModel& model);
  ~SimbodyModel();

  WholeBodyState At(const Posture& posture) const;

  // Velocities and accelerations are those of a PoseTrajectory: 6 + joints; kGravity pulls along
  // -z.

  /// Inverse dynamics.
  WholeBodyMotion Moving(const Posture& posture, const Eigen::VectorXd& velocities,
                         const Eigen::VectorXd& accelerations) const;

  /// Forward dynamics: the accelerations under weight and `forces`, laid out as WholeBodyMotion's.
  /// Needs a body that moves with every joint, and none that follows another's.
  Eigen::VectorXd Accelerations(const Posture& posture, const Eigen::VectorXd& velocities,
                                const Eigen::VectorXd& forces) const;

 private:
  struct System;
  std::unique_ptr<System> system_;
};

}  // namespace mmm_converter
