// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace mmm_converter {

/// Frames [begin, end).
struct KnownFrames {
  int begin = 0, end = 0;
  int count() const { return end - begin; }
};

/// From the first to the last column that has a value: programs take no table that begins with
/// unknown rows. None has: all of them.
inline KnownFrames FramesWithValues(const Eigen::MatrixXd& values) {
  KnownFrames known = {0, static_cast<int>(values.cols())};
  const auto is_known = [&](int k) { return values.col(k).array().isFinite().any(); };
  while (known.begin < known.end && !is_known(known.begin)) ++known.begin;
  if (known.count() == 0) return {0, static_cast<int>(values.cols())};
  while (!is_known(known.end - 1)) --known.end;
  return known;
}

}  // namespace mmm_converter
