// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <vector>

namespace mmm_converter {

/// Finds a rigid object among the points of a frame by the distances between its markers, and
/// follows it from frame to frame.
class RigidFinder {
 public:
  /// p_OM: places of its markers, 3 x markers [m], at least three off a line.
  explicit RigidFinder(Eigen::Matrix3Xd p_OM);

  int num_markers() const { return static_cast<int>(p_OM_.cols()); }

  /// The point of each marker, -1: none; nowhere at all where the object is not there. Anywhere: by
  /// four markers, or by three that are all it has; a search that takes too long is given up.
  /// points: 3 x points [m], finite. Valid until the
  /// next call.
  const std::vector<int>& Find(const Eigen::Ref<const Eigen::Matrix3Xd>& points);

  /// The same in the frame after one in which it was there, near where it was or, if it was there
  /// two frames running, where it goes on to. It takes three markers in their places.
  const std::vector<int>& Follow(const Eigen::Ref<const Eigen::Matrix3Xd>& points);

 private:
  struct Triple {
    double shortest_side;  // [m]
    std::array<int, 3> markers;
  };
  struct Pair {
    double distance;
    int first, second;
  };
  /// What stays of the points that have been chosen when each is within reach of its place; true:
  /// enough to know the pose, which is then X_WO_.
  bool Fit(const Eigen::Ref<const Eigen::Matrix3Xd>& points);
  /// Markers without a point take the nearest free one within reach [m].
  void Complete(const Eigen::Ref<const Eigen::Matrix3Xd>& points, double reach);
  /// Fit, Complete and Fit again.
  bool Settle(const Eigen::Ref<const Eigen::Matrix3Xd>& points);
  /// Settles with all points that have been chosen, and without each in turn, and keeps what has
  /// the most points, then the nearest: one that is another marker's bends the pose, and nothing
  /// lies where it should any more. False: none of these settles.
  bool SettleWithoutOne(const Eigen::Ref<const Eigen::Matrix3Xd>& points);
  int CountFound() const;
  double SquaredResidual(const Eigen::Ref<const Eigen::Matrix3Xd>& points) const;

  Eigen::Matrix3Xd p_OM_;
  std::vector<Triple> triples_;  // the widest first
  std::vector<int> point_of_marker_, best_;
  Eigen::Matrix3Xd z_;  // the points of the markers, NaN: none
  Eigen::VectorXd weights_;
  Eigen::Isometry3d X_WO_ = Eigen::Isometry3d::Identity();
  std::vector<Pair> pairs_;  // of points, by distance
  // Of the frame before X_WO_'s.
  Eigen::Isometry3d last_X_WO_ = Eigen::Isometry3d::Identity();
  int frames_ = 0;  // running, in which it was there
};

}  // namespace mmm_converter
