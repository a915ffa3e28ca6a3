// SPDX-License-Identifier: MIT
#include "common/label/track/body_watch.h"

#include <algorithm>

namespace mmm_converter {

bool BodyWatch::Fits(int matched, int points, int markers) const {
  const int possible = std::max(policy_.fewest_points, std::min(points, markers));
  return matched >= policy_.fitting * possible;
}

void BodyWatch::Count(int matched, int points, int markers, double dt) {
  const int possible = std::max(policy_.fewest_points, std::min(points, markers));
  const bool is_there = policy_.counts_absence || 2 * possible > markers;
  unfit_ = is_there && !Fits(matched, points, markers) ? unfit_ + dt : 0;
}

bool BodyWatch::IsLookDue(double dt) {
  since_look_ += dt;
  if (since_look_ < policy_.every) return false;
  since_look_ = 0;
  return true;
}

bool BodyWatch::IsReplaced(double own_cost, double other_cost, int other_names) {
  const bool is_better = other_names >= policy_.other_names && other_cost < own_cost - policy_.gain;
  better_ = is_better ? better_ + 1 : 0;
  if (better_ < policy_.running) return false;
  better_ = 0;
  return true;
}

void BodyWatch::Restart() {
  unfit_ = 0;
  since_look_ = 0;
  better_ = 0;
}

}  // namespace mmm_converter
