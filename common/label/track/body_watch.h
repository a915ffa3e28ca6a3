// SPDX-License-Identifier: MIT
#pragma once

#include "common/label/tuning.h"

namespace mmm_converter {

/// Watches a body that is followed: whether it still fits, when another posture is looked for, and
/// whether what was found takes its place.
class BodyWatch {
 public:
  explicit BodyWatch(const WatchPolicy& policy) : policy_(policy) {}

  const WatchPolicy& policy() const { return policy_; }

  /// Whether so many markers with a point are enough, of so many points.
  bool Fits(int matched, int points, int markers) const;
  /// A frame, dt [s] after the last one: so many of the markers have one of its points.
  void Count(int matched, int points, int markers, double dt);
  /// Too few had a point for too long.
  bool IsLost() const { return unfit_ >= policy_.patience; }

  /// dt [s] later another posture is to be looked for, as long after the last time as the policy
  /// has it.
  bool IsLookDue(double dt);
  /// Whether a posture takes the body's place: costs of both, and how many names it gives
  /// otherwise.
  bool IsReplaced(double own_cost, double other_cost, int other_names = 0);

  /// The body was found anew.
  void Restart();

 private:
  WatchPolicy policy_;
  double unfit_ = 0;       // [s] in which too few had a point
  double since_look_ = 0;  // [s]
  int better_ = 0;         // looks running
};

}  // namespace mmm_converter
