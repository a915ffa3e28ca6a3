// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
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
/// clearly nearer than any other, and no farther than a person accelerates. A recording's columns
/// do not count: a column may hold several things.
PointTracks FollowPoints(const MarkerSequence& recording);

}  // namespace mmm_converter
