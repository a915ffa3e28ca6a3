// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "common/dynamics/simbody_model.h"
#include "common/model/kinematic_model.h"
#include "common/motion/body_contacts.h"
#include "common/motion/foot_motion.h"
#include "common/motion/foot_states.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter {

struct DynamicsOptions {
  /// Of the zero-phase low-pass before a motion without derivatives is differentiated [Hz]; 0:
  /// none. Lowered to 0.4 times the rate where that is less. Derivatives in the motion are used as
  /// they are.
  double cutoff = 6;
  double shortest_flight = 0.1;  ///< ballistic phases that last less are left out [s]
  /// Frames [first_frame, end_frame) are examined; low-pass and ground are of the whole motion.
  int first_frame = 0;
  int end_frame = std::numeric_limits<int>::max();
};

/// Where velocities and accelerations come from.
enum class DerivativeSource {
  kMotion,    ///< the motion has them, as a smoother's
  kLowPassed  ///< differences of the motion after a low-pass; without one if cutoff is 0
};

/// What differentiation does. The residual force's rms deviation from its mean, in body weights;
/// without the frames that are not settled, where there are others.
struct Differentiation {
  DerivativeSource source = DerivativeSource::kMotion;
  double cutoff = 0;            ///< that was used [Hz]; 0: none
  bool cutoff_lowered = false;  ///< the rate did not allow the one asked for
  double raw_force_rms = 0;     ///< differences of the motion as it is
  double force_rms = 0;         ///< of the derivatives that were used
  double raw_force_peak = 0;    ///< largest |force| in body weights
  double force_peak = 0;
  /// What noise has of it (rms): what the low-pass takes away, times what white noise of positions
  /// has below the cut-off. Without a low-pass: all above the default cut-off. 0 of kMotion.
  double noise_force_rms = 0;
};

/// Frames [begin, end) in which no part of the body is near the ground.
struct BallisticPhase {
  int begin = 0;
  int end = 0;
  /// Of the least-squares parabola through the centre of mass [m/s^2]; z is to be -kGravity.
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();
  double parabola_rms = 0;  ///< distance of the centre of mass from it [m]
  /// Mean of MotionDynamics::com_acceleration [m/s^2].
  Eigen::Vector3d mean_acceleration = Eigen::Vector3d::Zero();
  double mean_force = 0;  ///< mean |residual force| in body weights; is to be 0
  Eigen::Vector3d angular_momentum = Eigen::Vector3d::Zero();  ///< mean [kg m^2/s]
  double angular_momentum_rms = 0;  ///< deviation |L - mean|, root mean square [kg m^2/s]
  double angular_momentum_max = 0;  ///< the same, largest
  /// Mean of the sum of all segments' |L| [kg m^2/s]: a measure for what rms and max mean where the
  /// mean vanishes.
  double segment_angular_momentum = 0;

  /// angular_momentum_rms relative to the mean's length.
  double AngularMomentumVariation() const { return angular_momentum_rms / angular_momentum.norm(); }
};

/// Largest distances between Simbody's and our own forward kinematics over the motion.
struct KinematicsAgreement {
  double marker_distance = 0;   ///< [m]
  double segment_distance = 0;  ///< origins [m]
  double segment_angle = 0;     ///< [rad]
};

/// What a motion asks of the body, by inverse dynamics without external forces: whatever the ground
/// does appears as a residual at the root. One column (entry) an examined frame; vectors in W.
struct MotionDynamics {
  double rate = 0;                       ///< [Hz]
  double first_time = 0;                 ///< [s]
  double mass = 0;                       ///< [kg]
  std::vector<std::string> joint_names;  ///< of the model, in its order
  int frames_with_held_joints = 0;       ///< where an angle was unknown: that of the nearest frame
  DynamicsOptions options;               ///< that were used
  /// Frames [settled_begin, settled_end) are at least a period of the low-pass away from the whole
  /// motion's ends, where nothing beyond holds the accelerations; equal where there is none.
  int settled_begin = 0;
  int settled_end = 0;

  Differentiation differentiation;
  KinematicsAgreement kinematics;

  Eigen::Matrix3Xd com;                      ///< physical centre of mass [m]
  Eigen::Matrix3Xd com_velocity;             ///< [m/s]
  Eigen::Matrix3Xd com_acceleration;         ///< [m/s^2]
  Eigen::Matrix3Xd linear_momentum;          ///< [kg m/s]
  Eigen::Matrix3Xd angular_momentum;         ///< about the centre of mass [kg m^2/s]
  Eigen::VectorXd segment_angular_momentum;  ///< sum of the segments' |L| about it [kg m^2/s]
  Eigen::MatrixXd joint_torques;             ///< joints x frames [N m]
  Eigen::MatrixXd joint_power;               ///< torque times velocity [W]
  Eigen::VectorXd kinetic_energy;            ///< [J]
  Eigen::VectorXd potential_energy;          ///< 0 at z = 0 [J]
  Eigen::Matrix3Xd residual_force;           ///< the sum of all external forces but weight [N]
  Eigen::Matrix3Xd residual_root_moment;     ///< about the root's origin [N m]
  Eigen::Matrix3Xd residual_moment;          ///< about the centre of mass [N m]
  /// Where the residual force meets the ground if the ground pushes up and turns about z only [m];
  /// NaN where it pushes with less than 0.1 body weights.
  Eigen::Matrix2Xd center_of_pressure;
  /// Distance of the centre of pressure outside of the convex hull of all touching contact bodies
  /// [m]; 0: within; NaN: none, or nothing touches.
  Eigen::VectorXd outside_support;

  FootContacts feet;         ///< of the whole motion; none: the model has no feet that are known
  double ground_height = 0;  ///< estimated [m]
  std::vector<ContactBody> contact_bodies;
  Eigen::MatrixXd contact_heights;  ///< as GroundContact::heights
  Eigen::VectorXd raised;           ///< as GroundContact::raised
  Eigen::MatrixXi contacts;         ///< bodies x frames: 1 touches, 0 does not

  std::vector<BallisticPhase> ballistic_phases;

  int num_frames() const { return static_cast<int>(com.cols()); }
  double time(int k) const { return first_time + k / rate; }
  double body_weight() const { return mass * kGravity; }  ///< [N]
};

/// When the feet of a motion stand.
using ContactFinder = std::function<FootContacts(const FootMotion&)>;

/// The model is scaled, with masses. z is up. Joints that the motion does not name are 0.
/// find_contacts: by what tells more than the motion, which it is asked for before the low-pass;
/// empty: FindSlowContacts.
/// progress(done, all): examined frames; may be empty. What it throws ends the work.
/// @throws Error where the model has no mass, an impossible inertia or lacks a joint of the motion,
///         or fewer than five frames are examined.
MotionDynamics ComputeMotionDynamics(const KinematicModel& model, const PoseTrajectory& motion,
                                     const DynamicsOptions& options = {},
                                     const std::function<void(int, int)>& progress = {},
                                     const ContactFinder& find_contacts = {});

}  // namespace mmm_converter
