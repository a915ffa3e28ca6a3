// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "common/retarget/retarget.h"

namespace mmm_converter {

/// How far a limb's half points elsewhere than the person's, as the pelvis sees it [rad].
struct LimbFigures {
  std::string name;  ///< "left thigh"
  double mean = 0, percentile95 = 0;
  double most = 0, most_time = 0;  ///< [s]
  std::vector<double> errors;      ///< in each frame; NaN: not known
};

/// A robot's foot in each frame.
struct FootFigures {
  Eigen::VectorXd height;  ///< of its lowest point above what it stands on, or the floor [m]
  Eigen::VectorXd speed;   ///< of what bears, from the frame before [m/s]; NaN: not in contact
};

/// A joint that stands at its limits.
struct JointFigures {
  std::string name;
  double share_at_limit = 0;  ///< of the frames, of position
  double share_at_speed = 0;  ///< of velocity
};

/// Two bodies of the robot that go into each other.
struct TouchFigures {
  std::string first, second;   ///< links
  double depth = 0, time = 0;  ///< the deepest [m], [s]
  double share = 0;            ///< of the frames
  bool is_by_mass = false;     ///< the size of one is known by its inertia only
};

/// A hand at what it holds.
struct HoldFigures {
  std::string object, hand;   ///< "left"
  double begin = 0, end = 0;  ///< [s]
  /// From where the person had it, in the object [m].
  double mean = 0, most = 0, most_time = 0;
};

/// What a robot did that followed a stream.
struct FollowedFigures {
  int holds = 0, returns = 0;    ///< when its person was lost, and seen again
  double held = 0, seconds = 0;  ///< [s], of these
  int jumps = 0;                 ///< of the person, or begun anew far from them
};

/// A robot's motion in numbers; what each counts is in README.md.
struct RetargetFigures {
  double rate = 0;  ///< [Hz]
  int num_frames = 0;
  double contact_share = 0;  ///< of frames and feet
  double slide = 0;          ///< share of pairs of frames in contact; NaN: none
  double toe_slide = 0;      ///< by the toe's rule at 30 Hz, as others count
  double penetration = 0;    ///< deepest [m]
  double penetration_time = 0;
  double floating = 0;        ///< mean height in contact [m]
  double highest_stance = 0;  ///< of what a foot stands on, above the floor [m]
  std::array<FootFigures, 2> feet;
  int position_breaks = 0, velocity_breaks = 0;
  bool keeps_limits = true;  ///< Retargeted::keeps_limits
  double body_depth = 0;     ///< of arms, trunk or knees in the floor [m]
  double body_depth_time = 0;
  std::string deepest_body;           ///< link
  std::vector<TouchFigures> touches;  ///< the deepest first
  double acceleration = 0;            ///< rms of the joints that move [rad/s^2]
  double jerk = 0;                    ///< [rad/s^3]
  double largest_jump = 0;            ///< of a joint, from frame to frame [rad]
  double root_speed = 0;              ///< the most [m/s]
  FollowedFigures followed;
  double direction = 0, direction95 = 0;
  std::vector<LimbFigures> limbs;
  std::vector<JointFigures> joints;  ///< that are at a limit for a while, the longest first
  std::vector<HoldFigures> holds;
  bool is_mirrored = false, is_backwards = false;
  double path = 0;  ///< length over what the legs allow; NaN: the person stays
};

inline constexpr double kMoves = 0.01;  ///< [rad] of a joint that moves

/// Of a joint in one frame; speed: since the frame before [rad/s].
struct JointState {
  bool is_beyond, is_at_limit;    ///< of position
  bool is_too_fast, is_at_speed;  ///< of velocity
};
JointState StateOf(const Robot& robot, int joint, double q, double speed);
/// Where its shares are worth a word.
void AddJointFigures(JointFigures joint, RetargetFigures* figures);

RetargetFigures MeasureRetargeting(const Retargeted& retargeted, const Robot& robot,
                                   const RobotBody& body);

}  // namespace mmm_converter
