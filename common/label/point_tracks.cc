// SPDX-License-Identifier: MIT
#include "common/label/point_tracks.h"

#include <algorithm>
#include <limits>

namespace mmm_converter {

namespace {

constexpr double kAcceleration = 80;  // [m/s^2] of a quick hand or foot
constexpr double kNearby = 0.006;     // [m]
constexpr double kFarthest = 0.12;    // [m]
constexpr double kClearly = 3;        // times nearer than the next, beyond the slack

FramePoints PointsOf(const MarkerSequence& recording, int k) {
  FramePoints points;
  for (int c = 0; c < recording.num_labels(); ++c) {
    if (IsSeen(recording.frame(k).col(c))) points.columns.push_back(c);
  }
  points.p_WP.resize(3, static_cast<Eigen::Index>(points.columns.size()));
  for (Eigen::Index p = 0; p < points.p_WP.cols(); ++p) {
    points.p_WP.col(p) = recording.frame(k).col(points.columns[p]);
  }
  points.tracks.assign(points.columns.size(), -1);
  return points;
}

struct Nearest {
  int index = -1;
  double distance = std::numeric_limits<double>::infinity();
  double next = std::numeric_limits<double>::infinity();

  void Offer(int other, double d) {
    if (d < distance) {
      next = distance;
      distance = d;
      index = other;
    } else {
      next = std::min(next, d);
    }
  }
  bool IsClear() const { return next > kClearly * distance + kNearby; }
};

}  // namespace

PointTracks FollowPoints(const MarkerSequence& recording) {
  PointTracks result;
  const double dt = 1 / recording.rate();
  const double reach = std::min(kNearby + 0.5 * kAcceleration * dt * dt, kFarthest);
  Eigen::Matrix3Xd velocity;  // of the last frame's points, per frame
  for (int k = 0; k < recording.num_frames(); ++k) {
    FramePoints points = PointsOf(recording, k);
    const Eigen::Index count = points.p_WP.cols();
    Eigen::Matrix3Xd next_velocity = Eigen::Matrix3Xd::Zero(3, count);
    if (k > 0) {
      const FramePoints& last = result.frames.back();
      std::vector<Nearest> forward(last.columns.size());
      std::vector<Nearest> backward(points.columns.size());
      for (Eigen::Index a = 0; a < last.p_WP.cols(); ++a) {
        const Eigen::Vector3d expected = last.p_WP.col(a) + velocity.col(a);
        for (Eigen::Index b = 0; b < count; ++b) {
          const double d = (points.p_WP.col(b) - expected).norm();
          forward[a].Offer(static_cast<int>(b), d);
          backward[b].Offer(static_cast<int>(a), d);
        }
      }
      for (std::size_t b = 0; b < backward.size(); ++b) {
        const int a = backward[b].index;
        if (a < 0 || forward[a].index != static_cast<int>(b) || forward[a].distance > reach ||
            !forward[a].IsClear() || !backward[b].IsClear()) {
          continue;
        }
        points.tracks[b] = last.tracks[a];
        next_velocity.col(static_cast<Eigen::Index>(b)) =
            points.p_WP.col(static_cast<Eigen::Index>(b)) - last.p_WP.col(a);
      }
    }
    for (std::size_t p = 0; p < points.tracks.size(); ++p) {
      if (points.tracks[p] < 0) {
        points.tracks[p] = static_cast<int>(result.tracks.size());
        result.tracks.push_back({k, k, {}});
      }
      PointTrack& track = result.tracks[points.tracks[p]];
      track.end = k + 1;
      track.points.push_back(static_cast<int>(p));
    }
    velocity = std::move(next_velocity);
    result.frames.push_back(std::move(points));
  }
  return result;
}

}  // namespace mmm_converter
