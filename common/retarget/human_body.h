// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "common/motion/pose_trajectory.h"
#include "common/retarget/body_posture.h"

namespace mmm_converter {

/// A person's model, MMM's reference model or one of OpenSim, as a mapped body with feet.
struct HumanBody {
  BodyMap map;
  std::array<BodyPoint, 2> heels, toes;  ///< of markers HEE and TOE, else where the sole ends
  /// In the foot, the heel's segment: columns forward, left and up of a foot that stands flat.
  std::array<Eigen::Matrix3d, 2> R_FA;
  double ankle_height = 0;                  ///< above the sole [m]
  std::array<double, 2> heel_heights = {};  ///< of `heels` above the sole [m]
  std::array<double, 2> toe_heights = {};   ///< of `toes`

  /// Thigh, shank and ankle height [m].
  double leg_length() const {
    return map.legs[0]->upper.length + map.legs[0]->lower.length + ankle_height;
  }
  /// Upper arm and forearm [m].
  double arm_length() const { return map.arms[0]->upper.length + map.arms[0]->lower.length; }
};

/// In which the map is found: all angles are 0.
Posture StandingPosture(const KinematicModel& model);

/// @throws Error where the model's legs and arms are not known.
HumanBody FindHumanBody(const KinematicModel& model);

/// A person over time; all have as many frames.
struct HumanMotion {
  double rate = 0;  ///< [Hz]
  double first_time = 0;
  std::vector<BodyPosture> bodies;
  std::array<Eigen::Matrix3Xd, 2> heels, toes;         ///< [m], W
  std::array<std::vector<Eigen::Matrix3d>, 2> R_feet;  ///< axes R_FA in W

  int num_frames() const { return static_cast<int>(bodies.size()); }
};

HumanMotion MoveHuman(const KinematicModel& model, const HumanBody& body,
                      const PoseTrajectory& motion);

}  // namespace mmm_converter
