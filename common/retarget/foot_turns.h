// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/math/rotation.h"

namespace mmm_converter {

/// Of a foot's forward direction, W.
inline double YawOf(const Eigen::Vector3d& forward) { return std::atan2(forward.y(), forward.x()); }
/// > 0: heel up.
inline double PitchOf(const Eigen::Vector3d& forward) {
  return -std::asin(std::clamp(forward.z(), -1.0, 1.0));
}
/// Of a foot's left direction.
inline double RollOf(const Eigen::Vector3d& left) {
  return std::asin(std::clamp(left.z(), -1.0, 1.0));
}

/// Only the end of the foot that the person lifts goes up.
inline double GatedPitch(bool heel_stands, bool toe_stands, double pitch) {
  if (heel_stands && toe_stands) return 0;
  if (toe_stands) return std::max(0.0, pitch);
  if (heel_stands) return std::min(0.0, pitch);
  return pitch;
}

/// From value and slope at 0 to neither at 1, without acceleration at both: a quintic.
inline double Fading(double value, double slope, double t) {
  const double u = 1 - t;
  return u * u * u * (value * (1 + 3 * t + 6 * t * t) + slope * t * (1 + 3 * t));
}

/// A small motion from one pose to another: place, then turn (W).
using FootDifference = Eigen::Matrix<double, 6, 1>;
inline FootDifference Difference(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
  FootDifference difference;
  difference.head<3>() = to.translation() - from.translation();
  difference.tail<3>() = Log(Eigen::Quaterniond(to.linear() * from.linear().transpose()));
  return difference;
}
inline void Move(const FootDifference& difference, Eigen::Isometry3d* X) {
  X->translation() += difference.head<3>();
  X->linear() = Exp(difference.tail<3>()).toRotationMatrix() * X->linear();
}

}  // namespace mmm_converter
