// SPDX-License-Identifier: MIT
#include "common/angles/gait_feet.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace mmm_converter {
namespace {

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

/// On a straight line between frames; beyond the ends the last.
Eigen::Vector3d PlaceAt(const Eigen::Matrix3Xd& path, double frame) {
  const Eigen::Index last = path.cols() - 1;
  const double at = std::clamp(frame, 0.0, static_cast<double>(last));
  const auto before = static_cast<Eigen::Index>(at);
  const double share = at - static_cast<double>(before);
  return (1 - share) * path.col(before) + share * path.col(std::min(before + 1, last));
}

}  // namespace

GaitCycle FootProgression(const FootMotion& feet, const Stride& stride) {
  GaitCycle cycle;
  cycle.angle = {"foot", Name(stride.side), "progression"};
  cycle.side = stride.side;
  cycle.strides = 1;
  cycle.deviation.fill(kNotKnown);
  cycle.uncertainty.fill(kNotKnown);
  const FootPath& foot = feet.foot(stride.side);
  const double inwards = stride.side == Side::kLeft ? -1 : 1;
  for (int i = 0; i < GaitCycle::kSamples; ++i) {
    const double share = static_cast<double>(i) / (GaitCycle::kSamples - 1);
    const double frame = (stride.begin + share * stride.time() - feet.first_time) * feet.rate;
    const Eigen::Vector3d along = PlaceAt(foot.toe, frame) - PlaceAt(foot.heel, frame);
    const double turn = std::atan2(along.y(), along.x()) - stride.heading;
    cycle.mean[i] =
        stride.length > 0 ? inwards * std::remainder(turn, 2 * std::numbers::pi) : kNotKnown;
  }
  return cycle;
}

double DoubleSupport(const Stride& stride, const Contacts& contacts) {
  constexpr double kForever = std::numeric_limits<double>::infinity();
  const double off = stride.begin + stride.foot_off * stride.time();
  if (!std::isfinite(off)) return kNotKnown;
  double both = 0;
  for (const FootContact& other : contacts.contacts) {
    if (other.side == stride.side) continue;
    const double begin = std::max(stride.begin, other.begin.value_or(-kForever));
    both += std::max(0.0, std::min(off, other.end.value_or(kForever)) - begin);
  }
  return both / stride.time();
}

GaitCycle MeanOf(const std::vector<GaitCycle>& single) {
  GaitCycle mean = single.front();
  mean.strides = static_cast<int>(single.size());
  for (int i = 0; i < GaitCycle::kSamples; ++i) {
    double sum = 0, squares = 0, count = 0;
    for (const GaitCycle& one : single) {
      if (!std::isfinite(one.mean[i])) continue;
      sum += one.mean[i];
      ++count;
    }
    mean.mean[i] = sum / count;
    for (const GaitCycle& one : single) {
      const double apart = one.mean[i] - mean.mean[i];
      if (std::isfinite(apart)) squares += apart * apart;
    }
    mean.deviation[i] = count > 1 ? std::sqrt(squares / (count - 1)) : kNotKnown;
  }
  return mean;
}

}  // namespace mmm_converter
