// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/model/kinematic_model.h"
#include "common/model/posture.h"

namespace mmm_converter {

inline constexpr double kStandardGravity = 9.80665;  ///< [m/s^2]

/// What something outside exerts on a segment, in W.
struct BodyWrench {
  int segment = 0;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N]
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< about W's origin [N m]
};

/// The forces by which a body moves as it does, beside weight along -z and the wrenches: force on
/// the root (W) [N], moment about its origin (W) [N m], then the generalised forces of the joints
/// [N m], sliding [N]. The recursion of Newton and Euler (Featherstone, "Rigid Body Dynamics
/// Algorithms", 2008, section 5.3) over segments, of which several may follow one joint by
/// functions. What couplers lead counts to its leader. velocities, accelerations: as
/// PoseTrajectory has them, all joints of the model. carried: by segment, the moment by which its
/// parent holds it, about its own origin (W) [N m]; null: not wanted.
Eigen::VectorXd InverseDynamics(const KinematicModel& model, const Posture& posture,
                                const Eigen::VectorXd& velocities,
                                const Eigen::VectorXd& accelerations,
                                const std::vector<BodyWrench>& wrenches,
                                double gravity = kStandardGravity,
                                std::vector<Eigen::Vector3d>* carried = nullptr);

/// These as generalised forces of coordinates(), whose values are those of the posture [rad, m]:
/// conjugate to each coordinate. NaN: it is locked, or follows others.
Eigen::VectorXd ForcesOfCoordinates(const KinematicModel& model, const Posture& posture,
                                    const Eigen::VectorXd& values, const Eigen::VectorXd& forces);

}  // namespace mmm_converter
