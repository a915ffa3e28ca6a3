// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/retarget/robot_body.h"

namespace mmm_converter {

/// Joints that move nothing which follows a person, as those of fingers and necks: at rest.
void HoldIdleJoints(const Robot& robot, RobotBody* body);

/// Holds joints at given angles: "left_hand_*=30,left_thumb=-10" in degrees, of sliding joints in
/// millimetres; * is any text, and of several that fit a joint the last counts. They then follow
/// nobody.
/// @throws Error where no joint is called so, one is a leg's, or its limits do not allow the angle.
void HoldJoints(const Robot& robot, const std::string& angles, RobotBody* body);

/// Where held joints bend feet, as toes do: these angles become the model's at rest, at which soles
/// are found. Whether there are any.
bool BendFeet(const RobotBody& body, KinematicModel* model);

/// The posture's held joints exactly where they are held.
void PutHeldJoints(const RobotBody& body, Posture* posture);

}  // namespace mmm_converter
