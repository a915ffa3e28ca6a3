// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/support/index.h"

namespace mmm_converter {

/// Into MarkerSequence::labels(): a column of a frame.
using LabelIx = ListIndex<struct LabelTag>;

// [Hz] Slower or faster is a wrong unit or a damaged file, and squares of its steps overflow.
inline constexpr double kLowestRate = 1;
inline constexpr double kHighestRate = 1e5;

constexpr bool IsFrameRate(double rate) { return rate >= kLowestRate && rate <= kHighestRate; }

/// Labelled marker positions over time. A marker that is not seen is NaN in all three coordinates.
class MarkerSequence {
 public:
  MarkerSequence() = default;
  /// All positions NaN. rate [Hz] > 0, first_time [s].
  MarkerSequence(std::vector<std::string> labels, int num_frames, double rate, double first_time);

  const std::vector<std::string>& labels() const { return labels_; }
  int num_labels() const { return static_cast<int>(labels_.size()); }
  int num_frames() const { return num_frames_; }
  double rate() const { return rate_; }
  double first_time() const { return first_time_; }
  /// Time of frame k [s], never accumulated.
  double time(int k) const { return first_time_ + k / rate_; }

  int FindLabel(const std::string& label) const;  ///< -1 if there is none

  /// Positions p_WM of frame k, 3 x labels [m].
  Eigen::Map<const Eigen::Matrix3Xd> frame(int k) const;
  Eigen::Map<Eigen::Matrix3Xd> frame(int k);

  /// Frames [begin, end).
  MarkerSequence Slice(int begin, int end) const;

 private:
  std::vector<std::string> labels_;
  int num_frames_ = 0;
  double rate_ = 0;
  double first_time_ = 0;
  std::vector<double> p_WM_;  // frame-major, then label, then x y z
};

/// True where the marker is seen.
inline bool IsSeen(const Eigen::Ref<const Eigen::Vector3d>& p) { return p.allFinite(); }

}  // namespace mmm_converter
