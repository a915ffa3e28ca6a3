// SPDX-License-Identifier: MIT
// The part of NameJudge that is about labels that were exchanged with each other.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <tuple>

#include "common/convert/name_judge.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

// Of an exchanged pair both are far: the metatarsal heads, the nearest ones, 0.04 to 0.05 m each.
constexpr double kDoubtfulPair = 0.035;
constexpr double kNearer = 0.8;        ///< to each other's places, while postures are of their own
constexpr double kRemoved = 0.5;       ///< of the pair's distances, by an exchange
constexpr std::size_t kMostPairs = 8;  ///< that are tried at once, the nearest first
constexpr int kMostExchanges = 3;
// A posture that follows wrong labels, as a pelvis that is turned round, hides which they are: with
// one label this far away, any two of its limb may be exchanged [m].
constexpr double kAnywhere = 0.09;

std::string_view LimbsOrPartOf(const Landmark& landmark) {
  const std::string_view limbs = LimbsOf(landmark);
  return limbs.empty() ? std::string_view(landmark.part) : limbs;
}

}  // namespace

double NameJudge::GainOf(std::size_t i, std::size_t j) const {
  const Hypothesis &a = places_[i], &b = places_[j];
  const LabelReading &one = Chosen(a), &other = Chosen(b);
  const bool is_mirrored = one.landmark == other.landmark && one.side != other.side;
  const bool is_of_side = one.landmark != other.landmark && one.side == other.side;
  const Landmark &of_one = LandmarkOf(one), &of_other = LandmarkOf(other);
  if (!(is_mirrored || is_of_side) || LimbsOrPartOf(of_one) != LimbsOrPartOf(of_other)) return kNaN;
  const double from_a = Distance(a.label, a.markers[a.chosen]);
  const double from_b = Distance(b.label, b.markers[b.chosen]);
  const double exchanged =
      Distance(a.label, b.markers[b.chosen]) + Distance(b.label, a.markers[a.chosen]);
  const bool are_near = is_of_side && of_one.part == of_other.part &&
                        std::min(from_a, from_b) > kDoubtfulPair &&
                        exchanged < kNearer * (from_a + from_b);
  if (!are_near && !(std::max(from_a, from_b) > kAnywhere)) return kNaN;
  return from_a + from_b - exchanged;
}

std::vector<NameJudge::ExchangedPair> NameJudge::DoubtfulPairs() const {
  // By the landmarks that are exchanged: those of both sides together.
  std::map<std::pair<int, int>, std::pair<double, ExchangedPair>> of_landmarks;
  std::vector<std::pair<double, ExchangedPair>> pairs;
  for (std::size_t a = 0; a < places_.size(); ++a) {
    for (std::size_t b = a + 1; b < places_.size(); ++b) {
      std::size_t i = a, j = b;
      if (Chosen(places_[i]).landmark > Chosen(places_[j]).landmark) std::swap(i, j);
      const double gain = GainOf(i, j);
      if (std::isnan(gain)) continue;
      pairs.push_back({gain, {{i, j}}});
      const int one = Chosen(places_[i]).landmark, other = Chosen(places_[j]).landmark;
      if (one == other) continue;
      auto& [of_both, both] = of_landmarks[{one, other}];
      of_both += gain;
      both.emplace_back(i, j);
    }
  }
  for (auto& [unused, both] : of_landmarks) {
    if (both.second.size() > 1) pairs.push_back(std::move(both));
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<ExchangedPair> first;
  for (auto& [unused, pair] : pairs) {
    if (first.size() < kMostPairs) first.push_back(std::move(pair));
  }
  return first;
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
  for (const auto& [i, j] : pairs) ExchangeReadings(&places_[i], &places_[j], 1);
}

void NameJudge::ExchangeReadings(Hypothesis* one, Hypothesis* other, std::size_t markers_of_one) {
  const Hypothesis was_one = *one, was_other = *other;
  const LabelReading read_one = Chosen(*one), read_other = Chosen(*other);
  const auto take = [&](Hypothesis* taker, const LabelReading& reading, const Hypothesis& of) {
    std::vector<LabelReading>& readings = named_.labels[Ix(taker->label)].readings;
    readings.push_back(reading);
    const auto first = of.markers.begin() + static_cast<std::ptrdiff_t>(markers_of_one * of.chosen);
    taker->markers.insert(taker->markers.end(), first,
                          first + static_cast<std::ptrdiff_t>(markers_of_one));
    taker->chosen = readings.size() - 1;
  };
  take(one, read_other, was_other);
  take(other, read_one, was_one);
}

double NameJudge::TryExchange(const ExchangedPair& pairs, double height) {
  const double distance = SumOfDistances(pairs), all = MeanDistance();
  Exchange(pairs);
  Pose(height, {});
  const double gain = (all - MeanDistance()) * static_cast<double>(places_.size());
  const bool is_right =
      SumOfDistances(pairs) < (1 - kRemoved) * distance && gain > kRemoved * distance;
  return is_right ? gain : 0;
}

void NameJudge::ExchangePairs(double height) {
  const auto state = [&] {
    std::vector<std::vector<LabelReading>> readings;
    for (const NamedLabel& label : named_.labels) readings.push_back(label.readings);
    return std::tuple(places_, postures_, p_WM_, std::move(readings));
  };
  const auto restore = [&](const auto& kept) {
    std::vector<std::vector<LabelReading>> readings;
    std::tie(places_, postures_, p_WM_, readings) = kept;
    for (std::size_t l = 0; l < readings.size(); ++l) named_.labels[l].readings = readings[l];
  };
  std::set<std::size_t> exchanged;
  for (int i = 0; i < kMostExchanges; ++i) {
    const auto before = state();
    auto best = before;
    ExchangedPair found;
    double most = 0;
    for (const ExchangedPair& pairs : DoubtfulPairs()) {
      const bool is_done = std::any_of(pairs.begin(), pairs.end(), [&](const auto& pair) {
        return exchanged.contains(pair.first) || exchanged.contains(pair.second);
      });
      if (is_done) continue;
      const double gain = TryExchange(pairs, height);
      if (gain > most) {
        most = gain;
        best = state();
        found = pairs;
      }
      restore(before);
    }
    restore(best);
    if (found.empty()) return;
    for (const auto& [one, other] : found) {
      TellExchange(places_[one], places_[other]);
      exchanged.insert({one, other});
    }
  }
}

void NameJudge::TellExchange(const Hypothesis& a, const Hypothesis& b) {
  NamedLabel &one = named_.labels[Ix(a.label)], &other = named_.labels[Ix(b.label)];
  one.note = fmt::format("exchanged with {}", other.label);
  other.note = fmt::format("exchanged with {}", one.label);
  one.is_contradicted = other.is_contradicted = true;
}

}  // namespace mmm_converter
