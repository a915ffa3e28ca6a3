// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "common/motion/foot_states.h"
#include "common/motion/pose_trajectory.h"
#include "common/retarget/held_objects.h"
#include "common/retarget/human_body.h"
#include "common/retarget/robot_body.h"

namespace mmm_converter {

/// A person's motion on a robot.
struct Retargeted {
  PoseTrajectory motion;  ///< of all joints of the robot's model, as many frames as the person's
  double scale = 1;       ///< robot over person
  /// Velocity of the belt of a treadmill; `human` is as on a belt that stands [m/s].
  Eigen::Vector3d belt = Eigen::Vector3d::Zero();
  HumanMotion human;
  FootContacts contacts;  ///< of the person
  FootStates states;
  std::array<FootRests, 2> rests;
  double ankle_height = 0;             ///< of the person [m]
  std::vector<TrackedObject> objects;  ///< in the robot's world
  std::vector<Hold> holds;
  int iterations = 0;         ///< of the fit, the most
  bool keeps_limits = false;  ///< FitResult::has_converged
};

/// What tells a person's contacts, where the motion does not.
struct PersonsGround {
  const PoseTrajectory* recorded = nullptr;  ///< the motion at its own rate; null: it is that
  const FootContacts* contacts = nullptr;    ///< of the person; null: by the motion alone
};

/// What is known of the person: all but the robot's postures.
Retargeted DescribePerson(const KinematicModel& human_model, const PoseTrajectory& motion,
                          const Robot& robot, const RobotBody& body,
                          const PersonsGround& ground = {});

/// Of the robot's, until frame k [m].
Eigen::Vector3d WayOfBelt(const Retargeted& retargeted, int k);

/// Height of the floor on which the person stands [m].
double FloorOf(const Retargeted& retargeted);

/// README.md has the algorithm. human_model: a person's, of MMM or OpenSim. objects: as many frames
/// as the motion's.
/// @throws Error where the person's model is not known, the motion has fewer than three frames, or
/// there are objects for a robot without legs, which has no place in the person's world.
Retargeted RetargetMotion(const KinematicModel& human_model, const PoseTrajectory& motion,
                          const Robot& robot, const RobotBody& body,
                          const std::vector<TrackedObject>& objects = {},
                          const PersonsGround& ground = {});

}  // namespace mmm_converter
