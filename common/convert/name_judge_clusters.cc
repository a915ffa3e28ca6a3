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

bool NameJudge::ClusterPlace::IsWorn() const {
  return stray <= kMostClusterStray && away <= kFarthestWorn;
}

std::optional<NameJudge::ClusterPlace> NameJudge::FindPlace(int label, int marker,
                                                            double height) const {
  if (marker < 0) return std::nullopt;
  std::vector<Vector3d> places;
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    const Vector3d p = recording_.frame(frames_[f]).col(label);
    if (!p.allFinite()) continue;
    const Matrix3Xd& at = p_WM_[f];
    const Vector3d origin = at.col(marker + 1);
    Eigen::Matrix3d axes;
    for (int a = 0; a < 3; ++a) axes.col(a) = (at.col(marker + 2 + a) - origin) / height;
    places.emplace_back(axes.transpose() * (p - origin) / height);
  }
  if (places.empty()) return std::nullopt;
  ClusterPlace found;
  for (int a = 0; a < 3; ++a) {
    std::vector<double> values;
    values.reserve(places.size());
    for (const Vector3d& p : places) values.push_back(p[a]);
    found.p_SM[a] = Median(values);
  }
  std::vector<double> strays;
  strays.reserve(places.size());
  for (const Vector3d& p : places) strays.push_back(height * (p - found.p_SM).norm());
  found.stray = Median(strays);
  found.away = height * (found.p_SM - model_->markers()[Ix(marker)].p_SM).norm();
  return found;
}

void NameJudge::ExchangeClusters(double height) {
  const auto is_worn = [&](const Hypothesis& label, const Hypothesis& as) {
    const auto place = FindPlace(label.label, as.markers[FirstMarkerOf(as)], height);
    return !place || place->IsWorn();
  };
  for (std::size_t i = 0; i < clusters_.size(); ++i) {
    for (std::size_t j = i + 1; j < clusters_.size(); ++j) {
      Hypothesis &one = clusters_[i], &other = clusters_[j];
      if (is_worn(one, one) || is_worn(other, other)) continue;
      if (!is_worn(one, other) || !is_worn(other, one)) continue;
      ExchangeReadings(&one, &other, kClusterMarkers);
      TellExchange(one, other);
    }
  }
}

void NameJudge::PlaceClusters(double height) {
  ExchangeClusters(height);
  for (const Hypothesis& one : clusters_) {
    const auto place = FindPlace(one.label, one.markers[FirstMarkerOf(one)], height);
    if (place) PlaceCluster(one, *place);
  }
}

void NameJudge::PlaceCluster(const Hypothesis& one, const ClusterPlace& place) {
  NamedLabel& label = named_.labels[Ix(one.label)];
  const auto own = std::find_if(named_.set.places.begin(), named_.set.places.end(),
                                [&](const auto& p) { return p.marker == label.marker; });
  if (own == named_.set.places.end()) return;
  if (!place.IsWorn()) {
    label.note =
        place.stray > kMostClusterStray
            ? fmt::format("moves by {:.0f} mm on the {}", kMillimetres * place.stray, label.part)
            : fmt::format("{:.0f} mm from the {}", kMillimetres * place.away, label.part);
    label.marker.clear();
    label.is_contradicted = true;
    return;
  }
  own->p_SM = place.p_SM;
  is_placed_[Ix(one.label)] = true;
  for (MarkerPair& pair : named_.set.pairs) {
    if (pair.target == label.marker) pair.noise_scale = 1 + place.stray / kMostClusterStray;
  }
}

}  // namespace mmm_converter
