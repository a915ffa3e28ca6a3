// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "common/model/kinematic_model.h"
#include "common/model/posture.h"

namespace mmm_converter {

/// What Simbody computes at one posture; all in W.
struct WholeBodyState {
  std::vector<Eigen::Isometry3d> X_WS;  ///< of all segments, in the model's order [m]
  Eigen::Matrix3Xd p_WM;                ///< of all markers, 3 x markers [m]
  double mass = 0;                      ///< of the whole body [kg]
  Eigen::Vector3d center_of_mass;       ///< of the whole body [m]; NaN where it has no mass
  Eigen::Matrix3d central_inertia;      ///< of the whole body about its centre of mass [kg m^2]
};

/// A KinematicModel as a Simbody multibody system: for dynamics, and as an independent check of our
/// own kinematics. The only user of Simbody; this header is C++17, as Simbody's are.
class SimbodyModel {
 public:
  /// @throws Error where the inertia of a node is impossible.
  explicit SimbodyModel(const KinematicModel& model);
  ~SimbodyModel();

  WholeBodyState At(const Posture& posture) const;

 private:
  struct System;
  std::unique_ptr<System> system_;
};

}  // namespace mmm_converter
