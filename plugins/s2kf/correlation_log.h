// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "common/motion/marker_sequence.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter::s2kf {

/// Some hundred correlations of a track, evenly over its frames: they change as slowly as the
/// person turns, and each takes as much memory as fifty frames of postures.
class CorrelationLog {
 public:
  explicit CorrelationLog(const MarkerSequence& recording)
      : recording_(recording), step_(1 + recording.num_frames() / kMost) {}

  bool IsDue(int frame) const { return frame >= next_; }

  /// covariance: of [root position 3; root rotation 3; joints].
  void Keep(int frame, const Eigen::MatrixXd& covariance) {
    const Eigen::ArrayXd deviations = covariance.diagonal().array().max(0).sqrt();
    const Eigen::VectorXd scale = (deviations > 0).select(deviations.inverse(), 0.0);
    kept_.push_back({recording_.time(frame), scale.asDiagonal() * covariance * scale.asDiagonal()});
    next_ = frame + step_;
  }

  std::vector<PoseCorrelation> Take() { return std::move(kept_); }

 private:
  static constexpr int kMost = 500;

  const MarkerSequence& recording_;
  int step_, next_ = 0;
  std::vector<PoseCorrelation> kept_;
};

}  // namespace mmm_converter::s2kf
