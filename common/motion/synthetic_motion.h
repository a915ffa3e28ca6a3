// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/model/kinematic_model.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter {

// Made motions of a (scaled) MMM reference model at 100 Hz: joint angles run smoothly through
// keyframes inside the limits, and the root moves so that the supporting foot or hand stands still.
// The floor is z = 0, the subject looks along y.
/// @throws Error where the model lacks one of KitJointNames() or a contact node of MMM's model.

/// A motion as its keyframes tell it.
struct MotionScript {
  enum class Support { kToes, kFingertips, kPalms };

  /// From `begin` until the next one: nodes whose mean stands still.
  struct Contact {
    double begin;  ///< [s]; the support is handed over around it
    std::vector<std::string> nodes;
    Support support;
  };

  int num_frames = 0;
  std::vector<double> times;  ///< of the keyframes [s]
  /// Values at them: "roll", "pitch", "yaw" of the root and joints [rad]. Joints that no channel
  /// moves rest in a relaxed posture.
  std::map<std::string, std::vector<double>> keyframes;
  std::vector<Contact> contacts;
};

PoseTrajectory PlayScript(const KinematicModel& model, MotionScript script);

/// 675 frames: hands to the floor, one leg after the other up to a handstand (root roll to -183
/// degrees), and back to standing. The centre of pressure stays between what touches the floor.
PoseTrajectory MakeHandstand(const KinematicModel& model);

/// 200 frames: from standing on the left leg, right knee up, left arm ahead, right elbow bent, and
/// back: no side and no direction looks like another.
PoseTrajectory MakeRaisedKnee(const KinematicModel& model);

}  // namespace mmm_converter
