// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "common/model/kinematic_model.h"
#include "common/model/posture.h"

namespace mmm_converter {

/// How places and directions of segments change with a posture's tangent vector (Retract): sized
/// once, then computed posture by posture.
class SegmentJacobian {
 public:
  using Rows = Eigen::Matrix<double, 3, Eigen::Dynamic>;

  explicit SegmentJacobian(const KinematicModel& model);

  void Compute(const Posture& posture);

  const Eigen::Isometry3d& X_WS(int segment) const { return X_WS_[segment]; }
  const std::vector<Eigen::Isometry3d>& poses() const { return X_WS_; }
  /// The elements of the tangent vector that move a segment, ascending.
  const std::vector<int>& columns(int segment) const { return columns_[segment]; }
  /// Derivatives of a place fixed to the segment, a column for each of columns(segment); rows grow
  /// to as many and keep what they have beyond.
  void OfPoint(int segment, const Eigen::Vector3d& p_W, Rows* rows) const;
  /// Of a direction fixed to the segment.
  void OfDirection(int segment, const Eigen::Vector3d& d_W, Rows* rows) const;

 private:
  struct Mover {
    int segment;
    int place;  ///< in columns()
  };

  const KinematicModel& model_;
  std::vector<std::vector<int>> columns_;
  std::vector<std::vector<Mover>> movers_;
  std::vector<Eigen::Isometry3d> X_WS_;
  std::vector<Eigen::Vector3d> axes_;  ///< of joints, W, times the slope of their function
};

}  // namespace mmm_converter
