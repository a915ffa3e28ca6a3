// SPDX-License-Identifier: MIT
#include "common/label/worn_elsewhere.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace mmm_converter {

using Eigen::Vector3d;

namespace {

constexpr double kReach = 0.2;        // [m] from the model's place
constexpr double kLeastFrames = 10;   // of a track
constexpr double kLeastTime = 1;      // [s] of all tracks at a place
constexpr double kScatter = 0.015;    // [m] of a track about its place on the link, each coordinate
constexpr double kShareOfPath = 0.2;  // of how far the points move with the link
constexpr double kSamePlace = 0.03;   // [m]

double Scatter(const Vector3d& sum, double squares, double count) {
  return std::sqrt(std::max(0.0, squares / count - (sum / count).squaredNorm()) / 3);
}

}  // namespace

void WornElsewhere::Add(int marker, int track, const Vector3d& offset, const Vector3d& p_WP) {
  if (offset.norm() > kReach) return;
  Sums& sums = sums_[{marker, track}];
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

std::vector<std::pair<int, int>> WornElsewhere::Find(double dt) const {
  // Of a marker the place where its tracks are for longest.
  struct Place {
    double distance = 0;
    int marker = 0;
    Sums all;
    std::vector<int> tracks;
  };
  std::map<int, Place> places;
  for (const auto& [pair, seed] : sums_) {
    if (seed.count < kLeastFrames) continue;
    const Vector3d middle = seed.offset / seed.count;
    Place place{middle.norm(), pair.first, {}, {}};
    for (auto it = sums_.lower_bound({pair.first, 0}); it != sums_.end(); ++it) {
      const auto& [other, sums] = *it;
      if (other.first != pair.first) break;
      if (sums.count < kLeastFrames || sums.ScatterOfOffset() > kScatter) continue;
      if ((sums.offset / sums.count - middle).norm() > kSamePlace) continue;
      place.all += sums;
      place.tracks.push_back(other.second);
    }
    Place& best = places[pair.first];
    if (place.all.count > best.all.count) best = std::move(place);
  }
  std::vector<Place> nearest_first;
  for (auto& [unused, place] : places) {
    if (place.all.count * dt < kLeastTime) continue;
    if (place.all.ScatterOfOffset() > kShareOfPath * place.all.Path()) continue;
    nearest_first.push_back(std::move(place));
  }
  std::sort(nearest_first.begin(), nearest_first.end(),
            [](const Place& a, const Place& b) { return a.distance < b.distance; });
  std::vector<std::pair<int, int>> found;
  std::set<int> tracks;
  for (const Place& place : nearest_first) {
    for (const int track : place.tracks) {
      if (tracks.insert(track).second) found.emplace_back(place.marker, track);
    }
  }
  return found;
}

}  // namespace mmm_converter
