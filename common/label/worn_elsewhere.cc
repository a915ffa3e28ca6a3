// SPDX-License-Identifier: MIT
#include "common/label/worn_elsewhere.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace mmm_converter {

using Eigen::Vector3d;

namespace {

constexpr double kReach = 0.2;        // [m] from the model's place
constexpr double kLeastTime = 1;      // [s] of all tracks at a place
constexpr double kScatter = 0.015;    // [m] of a track about its place on the link, each coordinate
constexpr double kShareOfPath = 0.2;  // of how far the points move with the link
constexpr double kSamePlace = 0.03;   // [m]
constexpr std::size_t kMostPlaces =
    50;  // of a marker that are looked at: those of its longest tracks

double Scatter(const Vector3d& sum, double squares, double count) {
  return std::sqrt(std::max(0.0, squares / count - (sum / count).squaredNorm()) / 3);
}

}  // namespace

void WornElsewhere::Add(int marker, int track, const Vector3d& offset, const Vector3d& p_WP) {
  if (offset.norm() > kReach) return;
  Sums& sums = tracks_[{marker, track}];
  sums.count += 1;
  sums.offset += offset;
  sums.offset_squares += offset.squaredNorm();
  sums.p_WP += p_WP;
  sums.p_WP_squares += p_WP.squaredNorm();
}

WornElsewhere::Sums& WornElsewhere::Sums::operator+=(const Sums& more) {
  count += more.count;
  offset += more.offset;
  offset_squares += more.offset_squares;
  p_WP += more.p_WP;
  p_WP_squares += more.p_WP_squares;
  return *this;
}

double WornElsewhere::Sums::ScatterOfOffset() const {
  return Scatter(offset, offset_squares, count);
}

double WornElsewhere::Sums::Path() const { return Scatter(p_WP, p_WP_squares, count); }

WornElsewhere::Place WornElsewhere::FindPlace(int marker) const {
  std::vector<const Track*> tracks;
  for (auto it = tracks_.lower_bound({marker, 0}); it != tracks_.end() && it->first.first == marker;
       ++it) {
    const Sums& sums = it->second;
    if (sums.count >= kLeastFrames && sums.ScatterOfOffset() < kScatter) tracks.push_back(&*it);
  }
  std::stable_sort(tracks.begin(), tracks.end(), [](const Track* a, const Track* b) {
    return a->second.count > b->second.count;
  });
  Place best;
  for (std::size_t i = 0; i < std::min(tracks.size(), kMostPlaces); ++i) {
    const Vector3d middle = tracks[i]->second.MeanOffset();
    Place place{marker, middle.norm(), {}, {}};
    for (const Track* track : tracks) {
      if ((track->second.MeanOffset() - middle).norm() > kSamePlace) continue;
      place.all += track->second;
      place.tracks.push_back(track->first.second);
    }
    if (place.all.count > best.all.count) best = std::move(place);
  }
  return best;
}

std::vector<std::pair<int, int>> WornElsewhere::Find(double dt) const {
  std::vector<Place> nearest_first;
  for (auto it = tracks_.begin(); it != tracks_.end();
       it = tracks_.lower_bound({it->first.first + 1, 0})) {
    Place place = FindPlace(it->first.first);
    if (place.all.count * dt < kLeastTime) continue;
    if (place.all.ScatterOfOffset() > kShareOfPath * place.all.Path()) continue;
    nearest_first.push_back(std::move(place));
  }
  std::sort(nearest_first.begin(), nearest_first.end(),
            [](const Place& a, const Place& b) { return a.distance < b.distance; });
  std::vector<std::pair<int, int>> found;
  std::set<int> taken;
  for (const Place& place : nearest_first) {
    for (const int track : place.tracks) {
      if (taken.insert(track).second) found.emplace_back(place.marker, track);
    }
  }
  return found;
}

}  // namespace mmm_converter
