// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "common/motion/marker_sequence.h"

namespace mmm_converter {

/// The points of a frame that are seen.
struct FramePoints {
  Eigen::Matrix3Xd p_WP;     ///< 3 x points [m]
  std::vector<int> columns;  ///< of the recording
  std::vector<int> tracks;   ///< into PointTracks::tracks
};

/// One thing's way through the frames, as far as it can be followed without doubt.
struct PointTrack {
  int begin = 0, end = 0;   ///< frames
  std::vector<int> points;  ///< by frame, into FramePoints
};

/// The points of a recording without their names, and which of them follow each other.
struct PointTracks {
  std::vector<FramePoints> frames;
  std::vector<PointTrack> tracks;
};

/// Follows points from frame to frame at constant velocity: those that are each other's nearest,
/// clearly nearer than any other, and no farther than a person accelerates.
class PointFollower {
 public:
  /// For each point its place among those of the frame before, -1: it is new. points: 3 x points
  /// [m], finite; dt [s]: since the frame before. Valid until the next call.
  const std::vector<int>& Follow(const Eigen::Ref<const Eigen::Matrix3Xd>& points, double dt);

  /// All points of the next frame are new.
  void Forget() { last_.resize(3, 0); }

 private:
  struct Nearest {
    int index = -1;
    double distance = std::numeric_limits<double>::infinity();
    double next = std::numeric_limits<double>::infinity();
    void Offer(int other, double d);
    bool IsClear() const;
  };
  Eigen::Matrix3Xd last_ = Eigen::Matrix3Xd(3, 0);
  Eigen::Matrix3Xd velocity_, next_velocity_;  // [m/s]
  std::vector<Nearest> forward_, backward_;
  std::vector<int> followed_;
};

/// Follows the points of a recording. Its columns do not count: a column may hold several things.
PointTracks FollowPoints(const MarkerSequence& recording);

}  // namespace mmm_converter
