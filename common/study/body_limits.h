// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/convert/tracking_setup.h"
#include "common/motion/marker_sequence.h"
#include "common/motion/pose_trajectory.h"
#include "common/support/units.h"

namespace mmm_converter {

/// Share of the frames from which on a joint stands at a limit: joints of right recordings at most
/// 0.03.
inline constexpr double kStandsAtLimit = 0.05;

/// A joint of a leg that more than one marker shows. Shares are those of the frames that show
/// enough markers to say where joints are.
struct JointAtLimit {
  std::string joint;
  double share = 0;     ///< at a limit that is not the joint's rest
  double straight = 0;  ///< of a knee: at the end that is straight
  /// How far a knee would bend backwards there [rad]; NaN: it does not stand there, or is no knee.
  double bent_back = kNaN;
};

struct FoldedLeg {
  std::string side;  ///< "left" or "right"
  /// Of the frames in which the pelvis is upright, the share in which the ankle is above the hip;
  /// NaN: it never is.
  double share = kNaN;
};

struct FlatSole {
  std::string side;
  double slope = kNaN;  ///< median where its markers are lowest, toes up [rad]; NaN: hardly ever
};

/// What no body does for long.
struct BodyLimits {
  std::vector<JointAtLimit> joints;
  std::vector<FoldedLeg> legs;
  std::vector<FlatSole> soles;
};

/// Of the reference model; nothing of robots and OpenSim's bodies, whose limits are of their own
/// kinds. recording: what was tracked, the frames of the trajectory.
BodyLimits MeasureBodyLimits(const TrackingSetup& setup, const MarkerSequence& recording,
                             const PoseTrajectory& trajectory);

}  // namespace mmm_converter
