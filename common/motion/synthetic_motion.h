// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/model/kinematic_model.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter {

// Made motions of a (scaled) MMM reference model at 100 Hz: joint angles run smoothly through
// keyframes inside the limits, and the root moves so that the supporting foot or hand stands still.
// The floor is z = 0, the subject looks along y.
/// @throws Error where the model lacks one of KitJointNames() or a contact node of MMM's model.

/// 675 frames: hands to the floor, one leg after the other up to a handstand (root roll to -183
/// degrees), and back to standing. The centre of pressure stays between what touches the floor.
PoseTrajectory MakeHandstand(const KinematicModel& model);

/// 675 frames: step, hands to the floor, kick up to a handstand (root roll to -183 degrees), and
/// back to standing; without regard to balance.
PoseTrajectory MakeKickedHandstand(const KinematicModel& model);

/// 400 frames: a cartwheel to the right (root pitch from 0 through 90 to 360 degrees).
PoseTrajectory MakeCartwheel(const KinematicModel& model);

/// 200 frames: from standing on the left leg, right knee up, left arm ahead, right elbow bent, and
/// back: no side and no direction looks like another.
PoseTrajectory MakeRaisedKnee(const KinematicModel& model);

}  // namespace mmm_converter
