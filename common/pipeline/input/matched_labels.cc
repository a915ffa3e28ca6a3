// SPDX-License-Identifier: MIT
#include "common/pipeline/input/matched_labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "common/convert/marker_set.h"
#include "common/convert/skeleton_setup.h"
#include "common/convert/understood_labels.h"
#include "common/model/coordinate_map.h"
#include "common/pipeline/input/osim_setup.h"
#include "common/pipeline/input/trunk_axis.h"
#include "common/support/advice.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

/// Of a model with markers of its own: names of landmarks, where they pair more than names alike
/// do.
std::shared_ptr<const NamedMarkers> PairNames(const MarkerLabels& labels, const Input& input,
                                              const ConverterConfig& config) {
  constexpr int kFewest = 4;
  const bool is_free = config.marker_pairs.empty() && config.marker_set == "auto";
  if (!is_free || input.reference->coordinates() == nullptr) return nullptr;
  NamedMarkers named = PairByLandmarks(labels, *input.reference, ShippedLandmarks());
  const int alike = CountMappedMarkers(OwnMarkerSet(*input.reference), labels.names);
  if (named.num_used() < kFewest || named.num_used() <= alike) return nullptr;
  return std::make_shared<const NamedMarkers>(std::move(named));
}

/// Angles of OpenSim come of weights, without which hips are some 10 degrees elsewhere.
void TellWeights(const Input& input, const ConverterConfig& config, Warnings* warnings) {
  const bool is_free = config.marker_pairs.empty() && config.marker_set == "auto";
  if (!is_free || !input.model->model.coordinates()) return;
  const std::string weights = FindWeightsBeside(input.model_file, *input.reference);
  if (weights.empty()) return;
  Warn(warnings, fmt::format("all markers weigh the same; {} has the weights of OpenSim's inverse "
                             "kinematics: name it with {}",
                             weights, OptionText("marker-set")));
}

bool IsOfSkeleton(const Input& input, const ConverterConfig& config) {
  const bool is_free = config.marker_pairs.empty() && config.marker_set == "auto";
  return is_free && !input.recording.body.empty() && input.model->is_reference &&
         HasBody(*input.reference);
}

/// By the markers that a set places.
TrackingSetup MatchPlaced(const MarkerSet& set, const MarkerLabels& labels, const Input& input,
                          const ConverterConfig& config, Warnings* warnings) {
  ConverterConfig of_set = config;
  of_set.marker_pairs = set.pairs;
  TrackingSetup setup =
      MatchMarkers(labels, std::make_shared<const KinematicModel>(PlaceMarkers(set, *input.model)),
                   of_set, warnings);
  setup.marker_set = set.name;
  return setup;
}

}  // namespace

std::shared_ptr<const NamedMarkers> UnderstoodNames(const MarkerLabels& labels, const Input& input,
                                                    const ConverterConfig& config) {
  // A marker set is asked for, or knows as much, or names say too little: null.
  constexpr int kFewest = 4, kFewestOfLimb = 6, kFewestOfObject = 8;
  const Recording& recording = input.recording;
  const bool may_be_object = recording.mmm && !recording.mmm->is_of_person;
  const bool is_free = config.marker_pairs.empty() && config.marker_set == "auto";
  if (!is_free || !input.model->is_reference) return nullptr;
  const LandmarkTable& table = ShippedLandmarks();
  NamedMarkers named = ComposeNamedMarkers(labels, *input.reference, table);
  const bool is_limb =
      named.are_of_one_side() && named.num_used() + named.num_without_side() >= kFewestOfLimb;
  if (named.num_used() < (may_be_object ? kFewestOfObject : kFewest) && !is_limb) return nullptr;
  const auto known = FindKnownSet(labels, *input.reference);
  if (known && IsOfSet(named, *known)) return nullptr;
  if (recording.markers.num_frames() > 0) {
    named = UnderstandLabels(labels, recording.markers, *input.reference, table,
                             {ResolveJoints(config, *input.reference), !input.keeps_usual_places});
  }
  return std::make_shared<const NamedMarkers>(std::move(named));
}

MatchedLabels MatchLabels(const MarkerLabels& labels, const Input& input,
                          const ConverterConfig& config, Warnings* warnings) {
  if (input.reference->coordinates() && input.reference->markers().empty()) {
    throw Error(fmt::format("{}: has no markers; name a file that has them with {}",
                            input.model_file, OptionText("marker-file")));
  }
  TellWeights(input, config, warnings);
  MatchedLabels matched;
  if (IsOfSkeleton(input, config)) {
    const MarkerSet set =
        PlaceSkeleton(input.recording, *input.reference, ResolveJoints(config, *input.reference));
    matched.setup = MatchPlaced(set, labels, input, config, warnings);
    return matched;
  }
  matched.names = UnderstoodNames(labels, input, config);
  if (!matched.names) matched.names = PairNames(labels, input, config);
  if (!matched.names) {
    matched.setup = MatchMarkers(labels, input.reference, config, warnings);
    return matched;
  }
  matched.setup = MatchPlaced(matched.names->set, labels, input, config, warnings);
  return matched;
}

bool AreAllNamed(const MarkerLabels& labels, const Input& input, const ConverterConfig& config) {
  constexpr double kMost = 0.75;
  int seen = 0;
  for (std::size_t i = 0; i < labels.names.size(); ++i) {
    if (!labels.seen.empty() && !labels.seen[i]) continue;
    if (labels.names[i].empty() || labels.names[i].starts_with('*')) return false;
    ++seen;
  }
  int known = 0;
  if (config.marker_pairs.empty() && config.marker_set == "auto") {
    const auto set = FindKnownSet(labels, *input.reference);
    if (set) known = CountMappedMarkers(*set, labels.names);
    const NamedMarkers named = ComposeNamedMarkers(labels, *input.reference, ShippedLandmarks());
    known = std::max(known, named.num_used());
  } else {
    MarkerSet set;
    set.pairs = ResolveMarkerPairs(config, {}, *input.reference, &set.name);
    known = CountMappedMarkers(set, labels.names);
  }
  return seen > 0 && known >= kMost * seen;
}

TrackingSetup MatchLabels(const MarkerLabels& labels, Input* input, const ConverterConfig& config,
                          Warnings* warnings) {
  MatchedLabels matched = MatchLabels(labels, std::as_const(*input), config, warnings);
  input->reference = matched.setup.model;
  input->names = matched.names;
  if (input->recording.markers.num_frames() > 0) {
    LetTrunkDecideUpAxis(matched.setup, input, warnings);
  }
  return std::move(matched.setup);
}

void TellPlaces(const Input& input, TrackingSetup* setup) {
  if (input.names == nullptr || input.keeps_usual_places) return;
  ModelDescription description = DescriptionOf(*setup->model);
  bool is_any = false;
  for (const NamedLabel& one : input.names->labels) {
    const int marker = setup->model->FindMarker(one.marker);
    if (!one.is_cluster || one.readings.empty() || marker < 0) continue;
    const auto landmark = static_cast<std::size_t>(one.readings.front().landmark);
    description.markers[static_cast<std::size_t>(marker)].deviation =
        ShippedLandmarks().landmarks()[landmark].deviation;
    is_any = true;
  }
  if (is_any) setup->model = std::make_shared<const KinematicModel>(std::move(description));
}

}  // namespace mmm_converter
