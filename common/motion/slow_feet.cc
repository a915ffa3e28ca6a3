// SPDX-License-Identifier: MIT
#include "common/motion/slow_feet.h"

#include <algorithm>
#include <cmath>

#include "common/motion/ground_rules.h"

namespace mmm_converter {
namespace {

// Feet of slow persons never swing so fast: a share of their own fastest swing then, and what a
// foot of one who stands still does not reach [m/s].
constexpr double kSlowShare = 0.4;
constexpr double kSlowestStep = 0.15;

/// What a foot that stands is slower than, of kComesBelow.
double SlownessOf(const FootMotion& motion) {
  double fastest = 0;
  for (const FootPath& foot : motion.feet) {
    const Eigen::VectorXd slower = foot.heel_speed.cwiseMin(foot.toe_speed);
    if (slower.size() > 0) fastest = std::max(fastest, slower.maxCoeff());
  }
  return std::clamp(kSlowShare * fastest, kSlowestStep, kComesBelow) / kComesBelow;
}

/// The slower end of a foot that is low; else faster than what leaves.
Eigen::VectorXd LowSpeed(const FootPath& foot, const PointState& heel, const PointState& toe) {
  Eigen::VectorXd speed = Eigen::VectorXd::Constant(heel.speed.size(), 2 * kLeavesAbove);
  for (const PointState* point : {&heel, &toe}) {
    speed = (point->height.array() <= kLowHeight).select(speed.cwiseMin(point->speed), speed);
  }
  for (Eigen::Index k = 0; k < speed.size(); ++k) {
    if (foot.IsUpsideDown(k)) speed[k] = 2 * kLeavesAbove;
  }
  return speed;
}

/// Between k - 1 and k, where a straight line is at `level`.
double CrossingBefore(const Eigen::VectorXd& values, Eigen::Index k, double level) {
  const double step = values[k] - values[k - 1];
  return static_cast<double>(k - 1) + (step == 0 ? 1 : (level - values[k - 1]) / step);
}

std::vector<SlowFoot> SlowTimes(const Eigen::VectorXd& speed, double rate, double slowness) {
  const double below = slowness * kComesBelow, above = slowness * kLeavesAbove;
  std::vector<SlowFoot> times;
  bool stands = false;
  const Eigen::Index last = speed.size() - 1;
  for (Eigen::Index k = 0; k <= last; ++k) {
    if (!stands && speed[k] < below) {
      const double begin = k == 0 ? 0 : CrossingBefore(speed, k, below);
      stands = true;
      if (!times.empty() && begin - times.back().end < kShortestContact * rate) continue;
      times.push_back({begin, static_cast<double>(last)});
    } else if (stands && !(speed[k] <= above)) {
      stands = false;
      times.back().end = CrossingBefore(speed, k, above);
    }
  }
  if (stands) times.back().end = static_cast<double>(last);
  for (SlowFoot& one : times) {
    auto k = static_cast<Eigen::Index>(std::ceil(one.begin));
    while (k < last && speed[k] > below / 2) ++k;
    one.slowing = static_cast<double>(k) - one.begin;
    k = static_cast<Eigen::Index>(one.end);
    while (k > 0 && speed[k] > above / 2) --k;
    one.speeding = one.end - static_cast<double>(k);
  }
  std::erase_if(times,
                [&](const SlowFoot& one) { return one.end - one.begin < kShortestContact * rate; });
  return times;
}

}  // namespace

SlowFeet FindSlowFeet(const FootMotion& motion) {
  SlowFeet slow;
  if (motion.num_frames() < 3) return slow;
  const FootStates states = FindFootStates(motion);
  const double slowness = SlownessOf(motion);
  for (std::size_t i = 0; i < slow.size(); ++i) {
    slow[i] =
        SlowTimes(LowSpeed(motion.feet[i], states.heels[i], states.toes[i]), motion.rate, slowness);
  }
  return slow;
}

FootContacts FindSlowContacts(const FootMotion& motion) {
  const SlowFeet slow = FindSlowFeet(motion);
  FootContacts found;
  for (const Side side : kSides) {
    for (const SlowFoot& one : slow[static_cast<std::size_t>(side)]) {
      FootContact& contact = found.contacts.emplace_back();
      contact.side = side;
      if (one.begin > 0)
        contact.begin = motion.time(one.begin) + kBeginLag.SecondsOf(one.slowing / motion.rate);
      if (one.end < motion.num_frames() - 1) {
        contact.end = motion.time(one.end) + kEndLag.SecondsOf(one.speeding / motion.rate);
      }
      contact.begin_deviation = kBeginLag.DeviationOf(one.slowing / motion.rate);
      contact.end_deviation = kEndLag.DeviationOf(one.speeding / motion.rate);
    }
  }
  return found;
}

}  // namespace mmm_converter
