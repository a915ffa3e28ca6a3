// SPDX-License-Identifier: MIT
#include "common/label/track/point_tracks.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/label/tuning.h"
#include "common/math/square.h"

namespace mmm_converter {

namespace {

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

}  // namespace

void PointFollower::Nearest::Offer(int other, double d) {
  if (d < distance) {
    next = distance;
    distance = d;
    index = other;
  } else {
    next = std::min(next, d);
  }
}

bool PointFollower::Nearest::IsClear() const {
  return next > FollowTuning::kClearly * distance + FollowTuning::kNearby;
}

const std::vector<int>& PointFollower::Follow(const Eigen::Ref<const Eigen::Matrix3Xd>& points,
                                              double dt) {
  const double reach = std::min(FollowTuning::kNearby + 0.5 * FollowTuning::kAcceleration * dt * dt,
                                FollowTuning::kFarthest);
  const double farthest2 = Square(FollowTuning::kClearly * reach +
                                  FollowTuning::kNearby);  // beyond, nothing is in doubt
  forward_.assign(static_cast<std::size_t>(last_.cols()), {});
  backward_.assign(static_cast<std::size_t>(points.cols()), {});
  for (Eigen::Index a = 0; a < last_.cols(); ++a) {
    const Eigen::Vector3d expected = last_.col(a) + dt * velocity_.col(a);
    for (Eigen::Index b = 0; b < points.cols(); ++b) {
      const double d2 = (points.col(b) - expected).squaredNorm();
      if (d2 > farthest2) continue;
      const double d = std::sqrt(d2);
      forward_[a].Offer(static_cast<int>(b), d);
      backward_[b].Offer(static_cast<int>(a), d);
    }
  }
  followed_.assign(backward_.size(), -1);
  next_velocity_.setZero(3, points.cols());
  for (Eigen::Index b = 0; b < points.cols(); ++b) {
    const int a = backward_[b].index;
    if (a < 0 || forward_[a].index != b || forward_[a].distance > reach || !forward_[a].IsClear() ||
        !backward_[b].IsClear()) {
      continue;
    }
    followed_[b] = a;
    next_velocity_.col(b) = (points.col(b) - last_.col(a)) / dt;
  }
  last_ = points;
  velocity_.swap(next_velocity_);
  return followed_;
}

PointTracks FollowPoints(const MarkerSequence& recording) {
  PointTracks result;
  PointFollower follower;
  for (int k = 0; k < recording.num_frames(); ++k) {
    FramePoints points = PointsOf(recording, k);
    const std::vector<int>& followed = follower.Follow(points.p_WP, 1 / recording.rate());
    for (std::size_t p = 0; p < followed.size(); ++p) {
      if (followed[p] >= 0) {
        points.tracks[p] = result.frames.back().tracks[followed[p]];
      } else {
        points.tracks[p] = static_cast<int>(result.tracks.size());
        result.tracks.push_back({k, k, {}});
      }
      PointTrack& track = result.tracks[points.tracks[p]];
      track.end = k + 1;
      track.points.push_back(static_cast<int>(p));
    }
    result.frames.push_back(std::move(points));
  }
  return result;
}

}  // namespace mmm_converter
