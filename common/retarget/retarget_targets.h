// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "common/retarget/retarget.h"
#include "common/retarget/trajectory_fit.h"

namespace mmm_converter {

/// Where a robot's foot is to be in each frame.
struct FootTrack {
  std::vector<Eigen::Isometry3d> X_WF;
  std::vector<bool> stands;
};
using FootTracks = std::array<FootTrack, 2>;

/// What the robot has to do by the person's motion alone: the first pass. Feet go where the
/// person's go, scaled, and as far apart as the robot's hips ask.
FootTracks ScaledFeet(const Retargeted& retargeted, const RobotBody& body);

/// Of what the first pass made of the feet: in each stance exactly one place and direction on the
/// ground, where it had the foot on average, with its pitch about the edges; in between as it had
/// them, drawn to the places at the ends.
FootTracks AnchoredFeet(const Retargeted& retargeted, const RobotBody& body,
                        const FootTracks& first_pass);

/// How closely feet are followed.
struct FootDeviations {
  double stance_place, stance_turn, swing_place, swing_turn;  ///< [m], [rad]
};

/// The whole problem. feet: empty tracks for a robot without legs.
TrajectoryProblem MakeProblem(const Retargeted& retargeted, const Robot& robot,
                              const RobotBody& body, const FootTracks& feet,
                              const FootDeviations& deviations);

/// The root above which the person's pelvis is, upright, in the first frame.
Posture FirstPosture(const Retargeted& retargeted, const Robot& robot, const RobotBody& body);

}  // namespace mmm_converter
