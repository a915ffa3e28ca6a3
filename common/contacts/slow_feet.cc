// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "common/contacts/plate_bearers.h"
#include "common/math/statistics.h"

namespace mmm_converter {
namespace {

// A foot has come to rest below the one, and has left above the other [m/s]: where heel and toe of
// recorded walks are when plates say so.
constexpr double kStandsBelow = 0.8;
constexpr double kLeavesAbove = 1.0;
// Feet of slow persons never swing so fast: a share of their own fastest swing then, and what a
// foot of one who stands still does not reach [m/s].
constexpr double kSlowShare = 0.4;
constexpr double kSlowestStep = 0.15;
constexpr double kLeastLow = 0.06;        // [m] above the ground, at least
constexpr double kDeviations = 3;         // of the heights of standing feet
constexpr double kShortest = 0.05;        // [s] of a contact, and of a gap
constexpr double kRobustSpread = 1.4826;  // a normal deviation is so many median ones

struct Floor {
  double height = 0;
  double low = kLeastLow;  ///< at most so far above it
};

/// The floor off the plates, from the lower end of each foot while that is slow.
Floor FindFloor(const FootMotion& motion) {
  std::vector<double> heights;
  for (const FootPath& foot : motion.feet) {
    for (Eigen::Index k = 0; k < foot.heel.cols(); ++k) {
      const bool is_heel = foot.heel(2, k) < foot.toe(2, k);
      const double speed = is_heel ? foot.heel_speed[k] : foot.toe_speed[k];
      if (speed < kStandsBelow) heights.push_back(is_heel ? foot.heel(2, k) : foot.toe(2, k));
    }
  }
  Floor floor;
  if (heights.empty()) return floor;
  floor.height = Median(heights);
  for (double& height : heights) height = std::abs(height - floor.height);
  floor.low = std::max(kLeastLow, kDeviations * kRobustSpread * Median(heights));
  return floor;
}

bool IsLow(const Eigen::Vector3d& p, const Floor& floor, const RecordedForces& forces) {
  for (const PlateForces& one : forces.plates) {
    if (IsOver(one.plate, p)) return p.z() <= one.plate.p_WP.z() + floor.low;
  }
  return p.z() <= floor.height + floor.low;
}

/// What a foot that stands is slower than, of kStandsBelow.
double SlownessOf(const FootMotion& motion) {
  double fastest = 0;
  for (const FootPath& foot : motion.feet) {
    const Eigen::VectorXd slower = foot.heel_speed.cwiseMin(foot.toe_speed);
    if (slower.size() > 0) fastest = std::max(fastest, slower.maxCoeff());
  }
  return std::clamp(kSlowShare * fastest, kSlowestStep, kStandsBelow) / kStandsBelow;
}

/// The slower end of a foot that is low; else faster than what leaves.
Eigen::VectorXd LowSpeed(const FootPath& foot, const Floor& floor, const RecordedForces& forces) {
  Eigen::VectorXd speed(foot.heel.cols());
  for (Eigen::Index k = 0; k < speed.size(); ++k) {
    double slowest = 2 * kLeavesAbove;
    if (IsLow(foot.heel.col(k), floor, forces)) slowest = std::min(slowest, foot.heel_speed[k]);
    if (IsLow(foot.toe.col(k), floor, forces)) slowest = std::min(slowest, foot.toe_speed[k]);
    speed[k] = slowest;
  }
  return speed;
}

/// Between k - 1 and k, where a straight line is at `level`.
double CrossingBefore(const Eigen::VectorXd& values, Eigen::Index k, double level) {
  const double step = values[k] - values[k - 1];
  return static_cast<double>(k - 1) + (step == 0 ? 1 : (level - values[k - 1]) / step);
}

std::vector<SlowFoot> SlowTimes(const Eigen::VectorXd& speed, double rate, double slowness) {
  const double below = slowness * kStandsBelow, above = slowness * kLeavesAbove;
  std::vector<SlowFoot> times;
  bool stands = false;
  const Eigen::Index last = speed.size() - 1;
  for (Eigen::Index k = 0; k <= last; ++k) {
    if (!stands && speed[k] < below) {
      const double begin = k == 0 ? 0 : CrossingBefore(speed, k, below);
      stands = true;
      if (!times.empty() && begin - times.back().end < kShortest * rate) continue;
      times.push_back({begin, static_cast<double>(last)});
    } else if (stands && !(speed[k] <= above)) {
      stands = false;
      times.back().end = CrossingBefore(speed, k, above);
    }
  }
  if (stands) times.back().end = static_cast<double>(last);
  std::erase_if(times, [&](const SlowFoot& one) { return one.end - one.begin < kShortest * rate; });
  return times;
}

}  // namespace

SlowFeet FindSlowFeet(const FootMotion& motion, const RecordedForces& forces) {
  SlowFeet slow;
  if (motion.num_frames() < 3) return slow;
  const Floor floor = FindFloor(motion);
  const double slowness = SlownessOf(motion);
  for (std::size_t i = 0; i < slow.size(); ++i) {
    slow[i] = SlowTimes(LowSpeed(motion.feet[i], floor, forces), motion.rate, slowness);
  }
  return slow;
}

}  // namespace mmm_converter
