// SPDX-License-Identifier: MIT
#pragma once

#include "common/retarget/foot_figures.h"
#include "common/retarget/robot_body.h"

namespace mmm_converter {

/// The robot as it follows a person who stands upright, arms hanging a little apart.
Posture StandingRobot(const Robot& robot, const RobotBody& body);

/// Of the body's capsules the pairs that do not touch at the zero pose or where it stands, joints
/// held as they are, and the balls that are above the floor there.
void WatchContacts(const Robot& robot, RobotBody* body);

/// How deep arms, trunk and knees are in the floor.
void MeasureBodyDepth(const PoseTrajectory& motion, const RobotBody& body,
                      const PosesOverTime& X_WS, RetargetFigures* figures);

void MeasureSelfContact(const PoseTrajectory& motion, const RobotCapsules& capsules,
                        const PosesOverTime& X_WS, RetargetFigures* figures);

}  // namespace mmm_converter
