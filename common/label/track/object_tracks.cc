// SPDX-License-Identifier: MIT
#include "common/label/track/object_tracks.h"

#include <algorithm>

#include "common/label/search/rigid_finder.h"
#include "common/label/tuning.h"

namespace mmm_converter {

namespace {

/// Objects in one frame after the other. Those that are followed come first, the others are looked
/// for in what these leave.
class ObjectSearch {
 public:
  explicit ObjectSearch(const std::vector<LabelObject>& objects) {
    for (const LabelObject& object : objects) finders_.emplace_back(object.p_OM);
    until_search_.assign(finders_.size(), 0);
    found_.resize(finders_.size());
  }

  /// By object, the point of each marker, -1: none.
  const std::vector<std::vector<int>>& Find(const Eigen::Matrix3Xd& points) {
    is_held_.assign(static_cast<std::size_t>(points.cols()), 0);
    for (std::size_t i = 0; i < finders_.size(); ++i) {
      found_[i] = finders_[i].Follow(points);
      Hold(found_[i]);
    }
    for (std::size_t i = 0; i < finders_.size(); ++i) {
      const bool is_there =
          std::any_of(found_[i].begin(), found_[i].end(), [](int p) { return p >= 0; });
      if (is_there) until_search_[i] = 0;
      if (is_there || --until_search_[i] > 0) continue;
      until_search_[i] = ObjectTuning::kSearchEvery;
      std::vector<int> left;
      for (int p = 0; p < points.cols(); ++p) {
        if (is_held_[p] == 0) left.push_back(p);
      }
      found_[i] = finders_[i].Find(points(Eigen::all, left));
      for (int& point : found_[i]) point = point < 0 ? -1 : left[point];
      Hold(found_[i]);
    }
    return found_;
  }

 private:
  void Hold(const std::vector<int>& point_of_marker) {
    for (const int point : point_of_marker) {
      if (point >= 0) is_held_[point] = 1;
    }
  }

  std::vector<RigidFinder> finders_;
  std::vector<int> until_search_;  // frames
  std::vector<std::vector<int>> found_;
  std::vector<char> is_held_;  // by point
};

}  // namespace

TrackNames FindObjectTracks(const std::vector<LabelObject>& objects, const PointTracks& tracks,
                            int first_marker, const std::function<void(int)>& at_frame) {
  TrackVotes votes(tracks.tracks.size());
  int end_marker = first_marker;
  for (const LabelObject& object : objects) end_marker += static_cast<int>(object.p_OM.cols());
  ObjectSearch search(objects);
  for (std::size_t k = 0; k < tracks.frames.size() && !objects.empty(); ++k) {
    const FramePoints& points = tracks.frames[k];
    int marker = first_marker;
    for (const std::vector<int>& point_of_marker : search.Find(points.p_WP)) {
      for (const int point : point_of_marker) {
        if (point >= 0) votes[points.tracks[point]][marker] += 1;
        ++marker;
      }
    }
    at_frame(static_cast<int>(k));
  }
  return ResolveVotes(votes, tracks, end_marker, ObjectTuning::kTrackShare);
}

}  // namespace mmm_converter
