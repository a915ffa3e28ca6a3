// SPDX-License-Identifier: MIT
#include "common/label/track/worn_elsewhere.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "common/label/tuning.h"

namespace mmm_converter {

using Eigen::Vector3d;

void WornElsewhere::Moments::Add(const Vector3d& v) {
  count += 1;
  sum += v;
  squares += v.squaredNorm();
}

void WornElsewhere::Moments::Add(const Moments& more) {
  count += more.count;
  sum += more.sum;
  squares += more.squares;
}

double WornElsewhere::Moments::Deviation() const {
  return std::sqrt(std::max(0.0, squares / count - Mean().squaredNorm()) / 3);
}

void WornElsewhere::Add(int marker, int track, const Vector3d& offset, const Vector3d& p_WP) {
  if (offset.norm() > ElsewhereTuning::kReach) return;
  Seen& seen = tracks_[{marker, track}];
  seen.offset.Add(offset);
  seen.p_WP.Add(p_WP);
}

WornElsewhere::Place WornElsewhere::FindPlace(int marker) const {
  std::vector<const Track*> tracks;
  for (auto it = tracks_.lower_bound({marker, 0}); it != tracks_.end() && it->first.first == marker;
       ++it) {
    const Moments& offset = it->second.offset;
    if (offset.count >= ElsewhereTuning::kLeastFrames &&
        offset.Deviation() < ElsewhereTuning::kScatter)
      tracks.push_back(&*it);
  }
  std::stable_sort(tracks.begin(), tracks.end(), [](const Track* a, const Track* b) {
    return a->second.offset.count > b->second.offset.count;
  });
  Place best;
  for (std::size_t i = 0; i < std::min(tracks.size(), ElsewhereTuning::kMostPlaces); ++i) {
    const Vector3d middle = tracks[i]->second.offset.Mean();
    Place place{marker, middle.norm(), {}, {}};
    for (const Track* track : tracks) {
      if ((track->second.offset.Mean() - middle).norm() > ElsewhereTuning::kSamePlace) continue;
      place.all.offset.Add(track->second.offset);
      place.all.p_WP.Add(track->second.p_WP);
      place.tracks.push_back(track->first.second);
    }
    if (place.all.offset.count > best.all.offset.count) best = std::move(place);
  }
  return best;
}

std::vector<std::pair<int, int>> WornElsewhere::Find(double dt, double reach) const {
  std::vector<Place> nearest_first;
  for (auto it = tracks_.begin(); it != tracks_.end();
       it = tracks_.lower_bound({it->first.first + 1, 0})) {
    Place place = FindPlace(it->first.first);
    if (place.all.offset.count * dt < ElsewhereTuning::kLeastTime || place.distance > reach)
      continue;
    const Seen& all = place.all;
    if (all.offset.Deviation() > ElsewhereTuning::kShareOfPath * all.p_WP.Deviation()) continue;
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
