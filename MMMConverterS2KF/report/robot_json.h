// SPDX-License-Identifier: MIT
#pragma once

#include "MMMConverterS2KF/report/json.h"
#include "common/retarget/robot_body.h"

namespace mmm_converter {

/// As ToJson of the model, with which part ("left leg", "right foot"; empty: the trunk) each
/// segment is of.
Json MappedModelJson(const KinematicModel& model, const BodyMap& map);

/// The same of a robot, with its shapes, where its limbs end, and of each joint its place in the
/// body ("knee"), side, and largest speed.
Json RobotJson(const Robot& robot, const RobotBody& body);

}  // namespace mmm_converter
