// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "common/model/kinematic_model.h"
#include "common/motion/ground_rules.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter {

enum class Side { kLeft, kRight };
inline constexpr std::array<Side, 2> kSides = {Side::kLeft, Side::kRight};
const char* Name(Side side);  ///< "left", "right"

/// Where a foot would touch the ground, a column a frame [m], W, and how fast that is against the
/// ground, after a low-pass [m/s].
struct FootPath {
  Eigen::Matrix3Xd heel, toe;
  Eigen::VectorXd heel_speed, toe_speed;
  Eigen::VectorXd upright;  ///< of the foot's up axis along W's; empty: always so
  Eigen::Vector3d belt = Eigen::Vector3d::Zero();  ///< of a treadmill, below this foot [m/s]

  bool IsUpright(Eigen::Index k) const { return upright.size() == 0 || upright[k] > kUprightFoot; }
  bool IsUpsideDown(Eigen::Index k) const { return upright.size() > 0 && upright[k] < 0; }
};

/// By side: the frames in which enough of the leg is seen.
using KnownLegs = std::array<std::vector<bool>, 2>;

/// Both feet of a tracked person.
struct FootMotion {
  double rate = 0;        ///< [Hz]
  double first_time = 0;  ///< [s]
  std::array<FootPath, 2> feet;
  /// The centre of mass, or the root of a model without masses, W [m]; empty: not known.
  Eigen::Matrix3Xd body;

  const FootPath& foot(Side side) const { return feet[static_cast<std::size_t>(side)]; }
  int num_frames() const { return static_cast<int>(feet[0].heel.cols()); }
  double time(double frame) const { return first_time + frame / rate; }
  /// The nearest one.
  int frame(double time) const {
    const double nearest = std::round((time - first_time) * rate);
    return static_cast<int>(std::clamp(nearest, 0.0, num_frames() - 1.0));
  }
};

/// Whether a model has the feet of MMM's reference model, or calcn and toes as OpenSim's have.
bool HasFeet(const KinematicModel& model);
/// The segment that the ground pushes, of the sole or the heel. The model HasFeet.
int FootSegment(const KinematicModel& model, Side side);

/// Speeds and belts from where the feet are. A treadmill: low feet move alike, and the person
/// hardly travels.
void FindSpeeds(FootMotion* motion);

/// From the postures alone: where markers were on the feet does not matter.
/// @throws Error where the model has no feet that are known.
FootMotion MoveFeet(const KinematicModel& model, const PoseTrajectory& motion);

}  // namespace mmm_converter
