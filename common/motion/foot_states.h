// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "common/motion/foot_motion.h"
#include "common/motion/ground_rules.h"

namespace mmm_converter {

/// A foot on the ground.
struct FootContact {
  Side side = Side::kLeft;
  /// [s]; nothing: it began before, or ended after, what was recorded.
  std::optional<double> begin, end;
  double begin_deviation = 0, end_deviation = 0;  ///< standard deviations [s]
  std::vector<int> plates;                        ///< numbers of those that bear it
};

struct FootContacts {
  std::vector<FootContact> contacts;  ///< the left foot's, then the right foot's, over time

  /// Of frames at first_time + k / rate [s, Hz]: whether a foot stands.
  std::vector<bool> StandingFrames(Side side, double first_time, double rate, int frames) const;
};

/// How high and how fast an end of a foot is, for each frame.
struct PointState {
  Eigen::VectorXd height;  ///< above the point's own level, and FootStates::supports [m]
  Eigen::VectorXd speed;   ///< against the ground, as FootPath has it [m/s]
  double level = 0;        ///< of the point where it stands, W [m]
};

/// Heel and toe of both feet.
struct FootStates {
  std::array<PointState, 2> heels, toes;
  /// Of what a foot stands on, a step say, above the floor [m] for each frame; none: the floor.
  std::array<Eigen::VectorXd, 2> supports;

  double support(std::size_t foot, int k) const {
    return supports[foot].size() > 0 ? supports[foot][k] : 0;
  }
};
/// The lowest place where a foot stands, if only for 30 ms, is the floor. A foot that is level and
/// slower than 0.2 m/s for 0.1 s more than 60 mm above it stands on something, if the other one
/// swings meanwhile or rests as high.
FootStates FindFootStates(const FootMotion& motion);

/// Frames [begin, end).
struct FrameInterval {
  int begin = 0, end = 0;
};

/// Which of a foot's ends rest on the ground (kRestHeight, kRestSpeed): what a robot's foot is held
/// at. Both may move while the foot comes to the ground or leaves it.
struct FootRests {
  std::vector<bool> heel, toe;
  std::vector<FrameInterval> stances;  ///< of either, on one thing
};
/// Within the person's contacts.
std::array<FootRests, 2> FindRests(const FootMotion& motion, const FootStates& states,
                                   const FootContacts& contacts);

/// Of as many frames at another rate, the nearest ones.
FootStates AtRate(const FootStates& states, double from, double to, int frames);
std::array<FootRests, 2> AtRate(const std::array<FootRests, 2>& rests, const FootStates& states,
                                double from, double to);

/// What figures of robots count as contact in a frame.
inline bool IsAtRest(const PointState& point, int k) {
  return point.height[k] < kRestHeight && point.speed[k] < kRestSpeed;
}

}  // namespace mmm_converter
