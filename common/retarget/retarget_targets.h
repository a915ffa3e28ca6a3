// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <optional>
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

/// What a place or direction of the robot follows of a person in one frame, but for feet.
struct PersonAim {
  int segment = 0;
  bool is_direction = false;
  Eigen::Vector3d local;
  double deviation = 1;  ///< [m], [rad]
  /// floor: height of the person's [m].
  std::function<Eigen::Vector3d(const BodyPosture& person, double floor)> target;
};
std::vector<PersonAim> AimsAtPerson(const Robot& robot, const RobotBody& body, double scale);
/// Without its targets.
Aim MakeAim(const PersonAim& of, int frames);

/// Where a person's foot puts the robot's.
struct ScaledFoot {
  const BodyPosture* person = nullptr;
  Eigen::Matrix3d R_foot;   ///< HumanMotion::R_feet
  double ankle_height = 0;  ///< of the person [m]
  double level = 0;         ///< of the person's sole where it stands [m]
  double scale = 1;
  std::optional<double> pitch;  ///< of a foot that stands; nothing: it swings
  double support = 0;           ///< of what the person's stands on, above the floor [m]
  double clearance = 0;         ///< of the lowest point of the person's that swings [m]
};
Eigen::Isometry3d PlaceFoot(const ScaledFoot& of, const RobotBody& body, std::size_t foot);

/// How closely feet are followed.
struct FootDeviations {
  double stance_place = 0, stance_turn = 0, swing_place = 0, swing_turn = 0;  ///< [m], [rad]
  double leaning = 0.1;  ///< of a foot that no joint rolls
};
FootDeviations Weighed(const FootDeviations& deviations, double weight);

/// Sole, toes' and left direction of a foot.
std::array<Aim, 3> MakeFootAims(const RobotFoot& foot, int frames);
void SetFootAims(const RobotFoot& foot, const Eigen::Isometry3d& X_WF, bool stands,
                 const FootDeviations& deviations, int frame, Aim* aims);

/// Without aims.
TrajectoryProblem EmptyProblem(const Robot& robot, const RobotBody& body, double rate, int frames);

/// The whole problem. feet: empty tracks for a robot without legs.
TrajectoryProblem MakeProblem(const Retargeted& retargeted, const Robot& robot,
                              const RobotBody& body, const FootTracks& feet,
                              const FootDeviations& deviations);

/// The root above which the person's pelvis is, upright.
Posture FirstPosture(const BodyPosture& person, double scale, const Robot& robot,
                     const RobotBody& body);

}  // namespace mmm_converter
