// SPDX-License-Identifier: MIT
// The part of NameJudge that is about labels that were exchanged with each other.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "common/convert/name_judge.h"

namespace mmm_converter {
namespace {

// Of an exchanged pair both are far: the metatarsal heads, the nearest ones, 0.04 to 0.05 m each.
constexpr double kDoubtfulPair = 0.035;
constexpr double kNearer = 0.8;        ///< to each other's places, while postures are of their own
constexpr double kRemoved = 0.5;       ///< of the pair's distances, by an exchange
constexpr std::size_t kMostPairs = 6;  ///< that are tried, the farthest first

}  // namespace

std::vector<NameJudge::ExchangedPair> NameJudge::DoubtfulPairs() const {
  std::vector<std::size_t> far;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (Distance(places_[i].label, places_[i].markers[places_[i].chosen]) > kDoubtfulPair) {
      far.push_back(i);
    }
  }
  // By the landmarks that are exchanged: those of both sides together.
  std::map<std::pair<int, int>, ExchangedPair> of_landmarks;
  std::vector<ExchangedPair> pairs;
  for (std::size_t a = 0; a < far.size(); ++a) {
    for (std::size_t b = a + 1; b < far.size(); ++b) {
      std::size_t i = far[a], j = far[b];
      if (Chosen(places_[i]).landmark > Chosen(places_[j]).landmark) std::swap(i, j);
      const LabelReading &one = Chosen(places_[i]), &other = Chosen(places_[j]);
      if (one.side != other.side || one.landmark == other.landmark) continue;
      if (LandmarkOf(one).part != LandmarkOf(other).part) continue;
      const double exchanged = Distance(places_[i].label, places_[j].markers[places_[j].chosen]) +
                               Distance(places_[j].label, places_[i].markers[places_[i].chosen]);
      if (!(exchanged < kNearer * SumOfDistances({{i, j}}))) continue;
      pairs.push_back({{i, j}});
      of_landmarks[{one.landmark, other.landmark}].emplace_back(i, j);
    }
  }
  for (auto& [unused, both] : of_landmarks) {
    if (both.size() > 1) pairs.push_back(std::move(both));
  }
  std::stable_sort(pairs.begin(), pairs.end(), [&](const auto& a, const auto& b) {
    return SumOfDistances(a) > SumOfDistances(b);
  });
  if (pairs.size() > kMostPairs) pairs.resize(kMostPairs);
  return pairs;
}

double NameJudge::SumOfDistances(const ExchangedPair& pairs) const {
  double sum = 0;
  for (const auto& [i, j] : pairs) {
    for (const std::size_t p : {i, j}) {
      const double distance = Distance(places_[p].label, places_[p].markers[places_[p].chosen]);
      if (!std::isnan(distance)) sum += distance;
    }
  }
  return sum;
}

void NameJudge::Exchange(const ExchangedPair& pairs) {
  for (const auto& [i, j] : pairs) {
    Hypothesis &one = places_[i], &other = places_[j];
    const LabelReading was_one = Chosen(one), was_other = Chosen(other);
    const int marker_of_one = one.markers[one.chosen],
              marker_of_other = other.markers[other.chosen];
    const auto take = [&](Hypothesis* taker, const LabelReading& reading, int marker) {
      std::vector<LabelReading>& readings = named_.labels[Ix(taker->label)].readings;
      readings.push_back(reading);
      taker->markers.push_back(marker);
      taker->chosen = readings.size() - 1;
    };
    take(&one, was_other, marker_of_other);
    take(&other, was_one, marker_of_one);
  }
}

void NameJudge::ExchangePairs(double height) {
  std::set<std::size_t> exchanged;
  for (const ExchangedPair& pairs : DoubtfulPairs()) {
    const bool is_done = std::any_of(pairs.begin(), pairs.end(), [&](const auto& pair) {
      return exchanged.contains(pair.first) || exchanged.contains(pair.second);
    });
    if (is_done) continue;
    const auto before = std::tuple(places_, postures_, p_WM_);
    std::vector<std::vector<LabelReading>> readings;
    for (const NamedLabel& label : named_.labels) readings.push_back(label.readings);
    const double distance = SumOfDistances(pairs), all = MeanDistance();
    Exchange(pairs);
    Pose(height, {});
    const double gain = (all - MeanDistance()) * static_cast<double>(places_.size());
    if (SumOfDistances(pairs) < (1 - kRemoved) * distance && gain > kRemoved * distance) {
      for (const auto& [i, j] : pairs) {
        NamedLabel& one = named_.labels[Ix(places_[i].label)];
        NamedLabel& other = named_.labels[Ix(places_[j].label)];
        one.note = fmt::format("exchanged with {}", other.label);
        other.note = fmt::format("exchanged with {}", one.label);
        one.is_contradicted = other.is_contradicted = true;
        exchanged.insert({i, j});
      }
      continue;
    }
    std::tie(places_, postures_, p_WM_) = before;
    for (std::size_t l = 0; l < readings.size(); ++l) named_.labels[l].readings = readings[l];
  }
}

}  // namespace mmm_converter
