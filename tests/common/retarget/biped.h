// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>

#include "common/model/robot.h"

namespace mmm_converter::testing {

/// How a robot made for the tests differs: 0.8 m of legs (thigh and shank 0.36, ankle 0.08 above
/// the sole), hips 0.2 apart, arms of 0.25 and 0.22; x forward, hanging arms.
struct BipedShape {
  std::array<std::string, 2> sides = {"left_", "right_"};  ///< before the names at +y and at -y
  double knee_lower = 0, knee_upper = 2.4;                 ///< about y
  double elbow_lower = -2.4, elbow_upper = 0;
  double hip_velocity = 20;  ///< [rad/s], of all hip joints
  bool has_legs = true;      ///< else the trunk stands on the world
  bool has_sole = true;
  bool has_bodies = false;   ///< trunk and forearms are boxes that touch
  bool has_fingers = false;  ///< two beyond a wrist, 0.1 to 1.5 rad, and a thumb, -1 to 1
  double palm = 0.08;        ///< from the wrist to the fingers
  bool has_toes = false;     ///< a joint about y 0.12 in front of the ankle
  bool has_clavicles = false;
  /// Origins along their axes: of the left hip roll, and of both shoulder pitches [m].
  double slip = 0;
  double right_thigh = 0.36;
  std::string elbow_axis = "0 1 0";
  bool elbow_bends_twice = false;  ///< another joint there, about x
  /// Knees and elbows are two joints, of which the second ("left_knee") mimics the first
  /// ("left_knee_half"), so far below it [m]; reversed: about the opposite axis.
  std::optional<double> halves = {};
  bool halves_reversed = false;
  double ankle_zero = 0;  ///< [rad] of feet at the zero pose, their toes down
};

/// A URDF.
std::string BipedText(const BipedShape& shape);
Robot MakeBiped(const BipedShape& shape);

}  // namespace mmm_converter::testing
