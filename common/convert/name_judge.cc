// SPDX-License-Identifier: MIT
#include "common/convert/name_judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "common/fit/height_estimate.h"
#include "common/fit/posture_search.h"
#include "common/math/statistics.h"
#include "common/model/model_scaling.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kJudgedFrames = 12;
constexpr int kPoseAttempts = 8;
constexpr double kLooser = 5;        // clusters, once a posture is found by them
constexpr int kFewestNamed = 4;      // labels of a frame that determine more than a pose
constexpr double kNobodysMass = 70;  // [kg]; no place depends on it

// Medians over the frames. Real persons' markers are some 0.02 to 0.08 m from their places, with a
// deviation of 0.028 on each axis.
constexpr double kFar = 0.09;         ///< another meaning is looked for [m]
constexpr double kDoubtful = 0.06;    ///< the same where the name has several [m]
constexpr double kFarDeviations = 3;  ///< the same of a landmark that is told less well
constexpr double kWrong = 0.2;        ///< it is not there at all [m]
constexpr double kWrongDeviations = 4.5;
constexpr double kNearby = 0.08;  ///< another meaning is right
constexpr double kBetter = 0.5;
constexpr double kExchangedShare = 0.75;  ///< of the distance, with sides exchanged

// Both labels of an exchanged pair are this far [m]: the metatarsal heads, the nearest ones, are
// exchanged by 0.04 to 0.05 m each.
constexpr double kDoubtfulPair = 0.035;
constexpr double kNearer = 0.8;        ///< to each other's places, while postures are of their own
constexpr double kRemoved = 0.5;       ///< of the pair's distances, by an exchange
constexpr std::size_t kMostPairs = 8;  ///< that are tried at once, the nearest first
constexpr int kMostExchanges = 3;
// A posture that follows wrong labels, as a pelvis that is turned round, hides which they are: with
// one label this far away, any two of its limb may be exchanged [m].
constexpr double kAnywhere = 0.09;

/// "arms", "legs" or neither.
std::string_view LimbsOf(const Landmark& landmark) {
  for (const char* part : {"upper arm", "forearm", "hand"}) {
    if (landmark.part == part) return "arms";
  }
  for (const char* part : {"thigh", "shank", "ankle", "foot"}) {
    if (landmark.part == part) return "legs";
  }
  return "";
}

std::string_view LimbsOrPartOf(const Landmark& landmark) {
  const std::string_view limbs = LimbsOf(landmark);
  return limbs.empty() ? std::string_view(landmark.part) : limbs;
}

constexpr double kMostClusterStray = 0.06;  ///< of its label about its place on the segment [m]
constexpr double kFarthestWorn = 0.3;  ///< of a cluster's label from where such are usually [m]

}  // namespace

NameJudge::NameJudge(const KinematicModel& reference, const std::vector<int>& joints,
                     const MarkerSequence& recording, const LandmarkTable& table,
                     NamedMarkers* named)
    : reference_(reference), joints_(joints), recording_(recording), table_(table), named_(*named) {
  is_placed_.resize(named->labels.size(), false);
  AddMirroredReadings();
  MakeModel();
  ChooseFrames();
}

void NameJudge::Run(bool places_clusters) {
  const double height = FindHeight();
  Pose(height, {});
  if (places_clusters && (!clusters_.empty() || IsAnyFar())) ExchangeSides(height);
  ExchangePairs(height);
  ChooseSegments();
  const std::vector<Hypothesis> none;
  const std::vector<Hypothesis>& clusters = places_clusters ? clusters_ : none;
  if (!clusters.empty()) Pose(height, clusters);
  for (int round = 0; round < 4 && Reconsider(); ++round) Pose(height, clusters);
  if (places_clusters) PlaceClusters(height);
}

double NameJudge::MeanDistance() const {
  constexpr double kMost = 0.3;
  double sum = 0;
  int count = 0;
  for (const Hypothesis& one : places_) {
    const double distance = Distance(one.label, one.markers[one.chosen]);
    if (std::isnan(distance)) continue;
    sum += one.is_out ? kMost : std::min(kMost, distance);
    ++count;
  }
  return sum / std::max(1, count);
}

void NameJudge::AddMirroredReadings() {
  for (NamedLabel& label : named_.labels) {
    std::vector<LabelReading> mirrored;
    for (const LabelReading& one : label.readings) {
      if (one.side == BodySide::kNone) continue;
      const bool is_left = one.side == BodySide::kLeft;
      mirrored.push_back({one.landmark, is_left ? BodySide::kRight : BodySide::kLeft});
    }
    label.readings.insert(label.readings.end(), mirrored.begin(), mirrored.end());
  }
}

void NameJudge::MakeModel() {
  ModelDescription description{reference_.name(), reference_.segments(), {}, {}};
  const auto add = [&](ModelMarker marker) {
    marker.name = fmt::format("{}", description.markers.size());
    description.markers.push_back(std::move(marker));
    return static_cast<int>(description.markers.size()) - 1;
  };
  for (std::size_t i = 0; i < named_.labels.size(); ++i) {
    const NamedLabel& label = named_.labels[i];
    if (label.marker.empty()) continue;
    Hypothesis one{static_cast<int>(i), {}, 0, false};
    const bool is_place = IsPlace(label.readings.front());
    for (const LabelReading& reading : label.readings) {
      const auto place = PlaceOf(reading, table_, reference_);
      if (is_place) {
        one.markers.push_back(place && IsPlace(reading) ? add(*place) : -1);
      } else if (!place || IsPlace(reading)) {
        one.markers.insert(one.markers.end(), kClusterMarkers, -1);
      } else {
        one.markers.push_back(add(*place));
        for (const Vector3d& p :
             {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, 0, 1)}) {
          one.markers.push_back(add({"", place->segment, p}));
        }
      }
    }
    (is_place ? places_ : clusters_).push_back(std::move(one));
  }
  model_.emplace(std::move(description));
}

void NameJudge::ChooseFrames() {
  for (int part = 0; part < kJudgedFrames; ++part) {
    const long n = recording_.num_frames();
    int best = -1, most = kFewestNamed - 1;
    for (int k = static_cast<int>(n * part / kJudgedFrames); k < n * (part + 1) / kJudgedFrames;
         ++k) {
      const auto frame = recording_.frame(k);
      const auto seen = std::count_if(places_.begin(), places_.end(), [&](const auto& one) {
        return IsSeen(frame.col(one.label));
      });
      if (seen <= most) continue;
      most = static_cast<int>(seen);
      best = k;
    }
    if (best >= 0) frames_.push_back(best);
  }
  postures_.resize(frames_.size());
}

std::vector<MarkerIx> NameJudge::ChosenMarkers() const {
  std::vector<MarkerIx> markers;
  markers.reserve(places_.size());
  for (const Hypothesis& one : places_) markers.emplace_back(one.markers[one.chosen]);
  return markers;
}

VectorXd NameJudge::NoiseScales() const {
  VectorXd scales(static_cast<Eigen::Index>(places_.size()));
  for (std::size_t i = 0; i < places_.size(); ++i) {
    scales[static_cast<Eigen::Index>(i)] = NoiseScaleOf(LandmarkOf(Chosen(places_[i])));
  }
  return scales;
}

double NameJudge::FindHeight() const {
  std::vector<LabelIx> labels;
  for (const Hypothesis& one : places_) labels.emplace_back(one.label);
  HeightOptions options;
  options.noise_scale = NoiseScales();
  options.with_ordinary_height = true;
  return EstimateHeight(*model_, joints_, ChosenMarkers(), labels, recording_, options).height;
}

Matrix3Xd NameJudge::Measured(int frame) const {
  Matrix3Xd z(3, static_cast<Eigen::Index>(places_.size()));
  for (std::size_t i = 0; i < places_.size(); ++i) {
    auto column = z.col(static_cast<Eigen::Index>(i));
    column = recording_.frame(frame).col(places_[i].label);
    if (places_[i].is_out) column.setConstant(kNaN);
  }
  return z;
}

void NameJudge::Pose(double height, const std::vector<Hypothesis>& clusters) {
  std::vector<MarkerIx> markers = ChosenMarkers();
  VectorXd scales = NoiseScales();
  const auto named = scales.size();
  std::vector<int> worn;
  for (const Hypothesis& one : clusters) {
    if (one.markers[FirstMarkerOf(one)] < 0) continue;
    worn.push_back(one.label);
    markers.emplace_back(one.markers[FirstMarkerOf(one)]);
    scales.conservativeResize(scales.size() + 1);
    scales[scales.size() - 1] = NoiseScaleOf(LandmarkOf(Chosen(one)));
  }
  const KinematicModel scaled = ScaleWinter(*model_, {height, kNobodysMass, {}});
  const MarkerKinematics kinematics(scaled, joints_, markers);
  std::vector<MarkerIx> all;
  all.reserve(model_->markers().size());
  for (int i = 0; i < static_cast<int>(model_->markers().size()); ++i) all.emplace_back(i);
  const MarkerKinematics everything(scaled, joints_, all);
  MarkerJacobian at = everything.MakeJacobian();
  PostureSearch search(kinematics);
  PostureFitOptions options;
  options.robust_distance = 0.1;
  // Clusters tell which way limbs bend; where they are worn they do not tell.
  VectorXd loose = scales;
  loose.tail(scales.size() - named) *= kLooser;
  std::vector<Matrix3Xd> z(frames_.size(), Matrix3Xd(3, scales.size()));
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    z[f].leftCols(named) = Measured(frames_[f]);
    z[f].rightCols(scales.size() - named) = recording_.frame(frames_[f])(Eigen::all, worn);
    search.Assemble(z[f], scales, options, kPoseAttempts, &postures_[f]);
  }
  // What one frame shows less clearly another one does.
  const auto take_over = [&](std::size_t from, std::size_t to) {
    search.ImproveFrom(postures_[from].joint_angles, z[to], scales, options, &postures_[to]);
  };
  for (std::size_t f = 1; f < frames_.size(); ++f) take_over(f - 1, f);
  for (std::size_t f = frames_.size(); f-- > 1;) take_over(f, f - 1);
  p_WM_.clear();
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    Posture& posture = postures_[f];
    if (!worn.empty()) search.fit().Solve(z[f], loose, options, &posture);
    everything.ComputeMarkers(posture.position, posture.orientation.toRotationMatrix(),
                              posture.joint_angles, &at);
    p_WM_.push_back(at.p_WM);
  }
}

double NameJudge::Distance(int label, int marker) const {
  std::vector<double> distances;
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    const Vector3d p = recording_.frame(frames_[f]).col(label);
    if (p.allFinite()) distances.push_back((p - p_WM_[f].col(marker)).norm());
  }
  return distances.empty() ? kNaN : Median(distances);
}

std::size_t NameJudge::MirroredReading(const Hypothesis& one) const {
  const std::vector<LabelReading>& readings = named_.labels[Ix(one.label)].readings;
  const LabelReading& chosen = readings[one.chosen];
  for (std::size_t r = 0; r < readings.size(); ++r) {
    const bool is_mirrored = readings[r].landmark == chosen.landmark &&
                             readings[r].side != chosen.side && chosen.side != BodySide::kNone;
    if (is_mirrored && (!IsPlace(chosen) || one.markers[r] >= 0)) return r;
  }
  return one.chosen;
}

bool NameJudge::IsOf(const Hypothesis& one, std::string_view limbs) const {
  return limbs == "all" || LimbsOf(LandmarkOf(Chosen(one))) == limbs;
}

bool NameJudge::IsAnyFar() const {
  return std::any_of(places_.begin(), places_.end(), [&](const Hypothesis& one) {
    return Distance(one.label, one.markers[one.chosen]) > kFar;
  });
}

void NameJudge::ExchangeSides(double height) {
  const auto before = std::tuple(places_, postures_, p_WM_);
  auto best = before;
  const double distance = MeanDistance();
  double least = kExchangedShare * distance;
  std::string_view exchanged_limbs = "none";
  for (const std::string_view limbs : {"all", "arms", "legs"}) {
    std::tie(places_, postures_, p_WM_) = before;
    for (Hypothesis& one : places_) {
      if (IsOf(one, limbs)) one.chosen = MirroredReading(one);
    }
    Pose(height, {});
    const double exchanged = MeanDistance();
    if (!(exchanged < least)) continue;
    least = exchanged;
    best = {places_, postures_, p_WM_};
    exchanged_limbs = limbs;
  }
  std::tie(places_, postures_, p_WM_) = std::move(best);
  const std::string note = fmt::format(
      "left and right are exchanged, or coordinates mirrored: {:.0f} mm from the model, "
      "exchanged {:.0f}",
      kMillimetres * distance, kMillimetres * least);
  const auto contradict = [&](const Hypothesis& one) {
    named_.labels[Ix(one.label)].is_contradicted = true;
    named_.labels[Ix(one.label)].note = note;
  };
  const std::vector<Hypothesis>& named = std::get<0>(before);
  for (std::size_t i = 0; i < named.size(); ++i) {
    if (named[i].chosen != places_[i].chosen) contradict(places_[i]);
  }
  for (Hypothesis& one : clusters_) {
    const std::size_t mirrored = IsOf(one, exchanged_limbs) ? MirroredReading(one) : one.chosen;
    if (mirrored == one.chosen) continue;
    one.chosen = mirrored;
    contradict(one);
  }
}

bool NameJudge::Reconsider() {
  std::vector<std::pair<double, Hypothesis*>> far;
  for (Hypothesis& one : places_) {
    if (one.is_out) continue;
    const double distance = Distance(one.label, one.markers[one.chosen]);
    const double bound =
        HasChoice(one) ? kDoubtful : std::max(kFar, kFarDeviations * DeviationOf(one));
    if (distance > bound) far.emplace_back(distance / bound, &one);
  }
  std::stable_sort(far.begin(), far.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  bool is_changed = false;
  for (std::size_t i = 0; 2 * i < far.size() + 1 && i < far.size(); ++i) {
    is_changed |= Reconsider(far[i].second);
  }
  return is_changed;
}

bool NameJudge::HasChoice(const Hypothesis& one) const {
  const NamedLabel& label = named_.labels[Ix(one.label)];
  return std::count_if(label.readings.begin(), label.readings.end(),
                       [&](const auto& reading) { return reading.side == Chosen(one).side; }) > 1;
}

bool NameJudge::Reconsider(Hypothesis* one) {
  NamedLabel& label = named_.labels[Ix(one->label)];
  const double distance = Distance(one->label, one->markers[one->chosen]);
  std::size_t best = one->chosen;
  double least = std::min(kNearby, kBetter * distance);
  for (std::size_t r = 0; r < one->markers.size(); ++r) {
    if (one->markers[r] < 0 || r == one->chosen) continue;
    const double other = Distance(one->label, one->markers[r]);
    if (other >= least) continue;
    least = other;
    best = r;
  }
  if (best != one->chosen) {
    label.note = fmt::format("worn {:.0f} mm from the {}, {:.0f} mm from the {}",
                             kMillimetres * distance, DescribeReading(Chosen(*one), table_),
                             kMillimetres * least, DescribeReading(label.readings[best], table_));
    label.is_contradicted |= label.readings[best].side != Chosen(*one).side;
    one->chosen = best;
    return true;
  }
  if (distance < std::max(kWrong, kWrongDeviations * DeviationOf(*one))) return false;
  label.note = fmt::format("{:.0f} mm from the {}", kMillimetres * distance,
                           DescribeReading(Chosen(*one), table_));
  label.is_contradicted = true;
  one->is_out = true;
  return true;
}

void NameJudge::Compose() {
  std::vector<std::string> labels;
  std::vector<ReadLabel> read;
  for (const NamedLabel& one : named_.labels) {
    labels.push_back(one.label);
    read.push_back({one.readings, one.marker.empty() ? one.note : ""});
  }
  for (const auto* hypotheses : {&places_, &clusters_}) {
    for (const Hypothesis& one : *hypotheses) {
      ReadLabel& label = read[Ix(one.label)];
      const auto first = label.readings.begin();
      const auto chosen = first + static_cast<std::ptrdiff_t>(one.chosen);
      std::rotate(first, chosen, chosen + 1);
      if (one.is_out) label.why_left_out = named_.labels[Ix(one.label)].note;
    }
  }
  NamedMarkers composed = ComposeNamedMarkers(labels, read, reference_, table_);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    NamedLabel& one = composed.labels[i];
    const NamedLabel& before = named_.labels[i];
    if (one.note.empty()) one.note = before.note;
    one.is_contradicted = before.is_contradicted;
    if (!is_placed_[i] || one.marker.empty()) continue;
    TakePlace(before, one, &composed.set);
  }
  named_ = std::move(composed);
}

void NameJudge::TakePlace(const NamedLabel& before, const NamedLabel& now, MarkerSet* set) const {
  for (const MarkerPlace& place : named_.set.places) {
    if (place.marker != before.marker) continue;
    for (MarkerPlace& own : set->places) {
      if (own.marker == now.marker) own.p_SM = place.p_SM;
    }
  }
  for (const MarkerPair& pair : named_.set.pairs) {
    if (pair.target != before.marker) continue;
    for (MarkerPair& own : set->pairs) {
      if (own.target == now.marker) own.noise_scale = pair.noise_scale;
    }
  }
}

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
