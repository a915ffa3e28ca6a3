// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/model/kinematic_model.h"
#include "common/motion/foot_states.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter {

/// A part of the body that can stand on the ground.
struct ContactBody {
  std::string name;  ///< "left foot", "right hand", ...; another model's: its last moved segment
  std::vector<int> segments;
  std::vector<int> markers;
};

/// Feet and hands of MMM's reference model; of other models, what hangs on the last joint of each
/// limb. The rest of the body is the last one, "body".
std::vector<ContactBody> ContactBodies(const KinematicModel& model);

/// Guesses: the points of a body are the origins of its segments and its markers.
struct GroundContact {
  /// Where the body's lowest point rests: the median of its heights, or clearly lower [m].
  double ground_height = 0;
  /// Bodies x frames: lowest point above the ground, or above what the body rests on [m].
  Eigen::MatrixXd heights;
  Eigen::MatrixXi touches;  ///< bodies x frames: 1 on the ground, else 0
  /// By frame: how far above the ground the body rests where no part of it is near that [m]; else
  /// 0.
  Eigen::VectorXd raised;
};

/// Of the feet of a person, `feet` where they are told; of other bodies what is lower than
/// kRestHeight and slower than kComesBelow. Both motions name all joints of the model; z is up.
/// Heights are those of `measured`, as a low-pass lifts a foot before it leaves the ground; speeds
/// those of `smooth`, as differences are mostly noise. Where no part of the body is near the
/// ground, one that rests, slower and longer than a fall allows, stands on something there: on
/// stairs, a box or a bar.
GroundContact FindGroundContact(const KinematicModel& model, const std::vector<ContactBody>& bodies,
                                const PoseTrajectory& measured, const PoseTrajectory& smooth,
                                const FootContacts* feet = nullptr);

/// How far the centre of pressure lies outside of the convex hull of the bodies that touch, seen
/// from above; one entry a frame [m], 0 within, NaN where nothing touches or a centre is NaN.
Eigen::VectorXd DistanceOutsideSupport(const KinematicModel& model,
                                       const std::vector<ContactBody>& bodies,
                                       const PoseTrajectory& motion, const GroundContact& contact,
                                       const Eigen::Matrix2Xd& centers_of_pressure);

/// Distance of p from the convex hull of `points` (at least one) [m]; 0 within.
double DistanceOutsideHull(std::vector<Eigen::Vector2d> points, const Eigen::Vector2d& p);

}  // namespace mmm_converter
