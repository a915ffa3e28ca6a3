// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "common/retarget/human_body.h"

namespace mmm_converter {

/// How high and how fast a point of a person's foot is, for each frame.
struct PointState {
  Eigen::VectorXd height;  ///< above the point's own level, and FootStates::supports [m]
  Eigen::VectorXd speed;   ///< from 20 ms before to 20 ms behind [m/s]
  double level = 0;        ///< of the point where it stands, W [m]
};
PointState StateOf(const Eigen::Matrix3Xd& path, double rate);

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
FootStates StatesOf(const HumanMotion& motion);

/// Frames [begin, end) in which a foot stands.
struct Stance {
  int begin = 0, end = 0;
};

/// Which of a foot's ends are on the ground: on below 40 mm and 0.3 m/s, off above 60 mm or
/// 0.5 m/s, for 80 ms at least; a point that stays below 60 mm is not off for less.
struct FootContacts {
  std::vector<bool> heel, toe;
  std::vector<Stance> stances;  ///< of either
};
std::array<FootContacts, 2> FindFootContacts(const FootStates& states, double rate);

/// Of as many frames at another rate, the nearest ones.
FootStates AtRate(const FootStates& states, double from, double to, int frames);
std::array<FootContacts, 2> AtRate(const std::array<FootContacts, 2>& contacts,
                                   const FootStates& states, double from, double to);

/// Below 40 mm and 0.3 m/s in this frame: what figures count as contact.
inline bool IsInContact(const PointState& point, int k) {
  return point.height[k] < 0.04 && point.speed[k] < 0.3;
}

}  // namespace mmm_converter
