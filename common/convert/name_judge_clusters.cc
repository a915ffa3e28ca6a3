// SPDX-License-Identifier: MIT
// The part of NameJudge that is about clusters.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "common/convert/name_judge.h"
#include "common/math/statistics.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr double kMostClusterStray = 0.06;  ///< of its label about its place on the segment [m]
constexpr double kFarthestWorn = 0.3;  ///< of a cluster's label from where such are usually [m]

}  // namespace

void NameJudge::ChooseSegments() {
  for (Hypothesis& one : clusters_) {
    const std::vector<LabelReading>& readings = named_.labels[Ix(one.label)].readings;
    const LabelReading named = Chosen(one);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t r = 0; r < readings.size(); ++r) {
      const int marker = one.markers[kClusterMarkers * r];
      if (marker < 0 || readings[r].side != named.side) continue;
      const double distance = Distance(one.label, marker);
      if (!(distance < least)) continue;
      least = distance;
      one.chosen = r;
    }
  }
}

void NameJudge::PlaceClusters(double height) {
  for (const Hypothesis& one : clusters_) {
    const std::size_t first = FirstMarkerOf(one);
    if (one.markers[first] < 0) continue;
    std::vector<Vector3d> places;
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      const Vector3d p = recording_.frame(frames_[f]).col(one.label);
      if (!p.allFinite()) continue;
      const Matrix3Xd& at = p_WM_[f];
      const Vector3d origin = at.col(one.markers[first + 1]);
      Eigen::Matrix3d axes;
      for (int a = 0; a < 3; ++a)
        axes.col(a) = (at.col(one.markers[first + Ix(2 + a)]) - origin) / height;
      places.emplace_back(axes.transpose() * (p - origin) / height);
    }
    if (!places.empty()) PlaceCluster(one, places, height);
  }
}

void NameJudge::PlaceCluster(const Hypothesis& one, const std::vector<Vector3d>& places,
                             double height) {
  Vector3d place;
  for (int a = 0; a < 3; ++a) {
    std::vector<double> values;
    values.reserve(places.size());
    for (const Vector3d& p : places) values.push_back(p[a]);
    place[a] = Median(values);
  }
  std::vector<double> strays;
  strays.reserve(places.size());
  for (const Vector3d& p : places) strays.push_back(height * (p - place).norm());
  const double stray = Median(strays);
  NamedLabel& label = named_.labels[Ix(one.label)];
  const Vector3d usual = model_->markers()[Ix(one.markers[FirstMarkerOf(one)])].p_SM;
  const double away = height * (place - usual).norm();
  const auto own = std::find_if(named_.set.places.begin(), named_.set.places.end(),
                                [&](const auto& p) { return p.marker == label.marker; });
  if (own == named_.set.places.end()) return;
  if (stray > kMostClusterStray || away > kFarthestWorn) {
    label.note = stray > kMostClusterStray
                     ? fmt::format("moves by {:.0f} mm on the {}", kMillimetres * stray, label.part)
                     : fmt::format("{:.0f} mm from the {}", kMillimetres * away, label.part);
    label.marker.clear();
    label.is_contradicted = true;
    return;
  }
  own->p_SM = place;
  is_placed_[Ix(one.label)] = true;
  for (MarkerPair& pair : named_.set.pairs) {
    if (pair.target == label.marker) pair.noise_scale = 1 + stray / kMostClusterStray;
  }
}

}  // namespace mmm_converter
