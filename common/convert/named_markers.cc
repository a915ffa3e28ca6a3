// SPDX-License-Identifier: MIT
#include "common/convert/named_markers.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "common/io/recording/marker_labels.h"
#include "common/model/kit_joints.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kMostWorn = 500;  // clusters of all limbs have some 150

/// Of each coordinate of a place of the model from where the marker is worn [m]: noise scale 1.
constexpr double kModelDeviation = 0.028;
constexpr double kLeastNoiseScale = 0.3;  ///< skin moves by as much as the best places are known to

const Landmark& LandmarkOf(const LabelReading& reading, const LandmarkTable& table) {
  return table.landmarks()[static_cast<std::size_t>(reading.landmark)];
}

std::string WithSide(const std::string& what, BodySide side) {
  if (side == BodySide::kNone) return what;
  return (side == BodySide::kLeft ? "left " : "right ") + what;
}

/// Of a segment or marker of the left, that of the right; the same where it is of no side.
std::string OnTheRight(const std::string& left) {
  for (const std::string_view prefix : {"MARKER_", "Hand ", ""}) {
    if (!left.starts_with(prefix)) continue;
    const std::string mirrored = MirroredName(left.substr(prefix.size()));
    return mirrored.empty() ? left : std::string(prefix) + mirrored;
  }
  return left;
}

}  // namespace

int NamedMarkers::num_used() const {
  return static_cast<int>(std::count_if(labels.begin(), labels.end(),
                                        [](const NamedLabel& one) { return !one.marker.empty(); }));
}

int NamedMarkers::num_without_side() const {
  return static_cast<int>(std::count_if(labels.begin(), labels.end(),
                                        [](const NamedLabel& one) { return one.lacks_side; }));
}

std::vector<std::string> DescribeContradictions(const NamedMarkers& named) {
  std::vector<std::string> labels, notes;
  for (const NamedLabel& one : named.labels) {
    if (!one.is_contradicted) continue;
    const auto same = std::find(notes.begin(), notes.end(), one.note);
    if (same == notes.end()) {
      labels.push_back(one.label);
      notes.push_back(one.note);
    } else {
      labels[static_cast<std::size_t>(same - notes.begin())] += ", " + one.label;
    }
  }
  for (std::size_t i = 0; i < labels.size(); ++i) labels[i] += fmt::format(" ({})", notes[i]);
  return labels;
}

std::string DescribeReading(const LabelReading& reading, const LandmarkTable& table) {
  return WithSide(LandmarkOf(reading, table).name, reading.side);
}

std::optional<ModelMarker> PlaceOf(const LabelReading& reading, const LandmarkTable& table,
                                   const KinematicModel& model) {
  const Landmark& landmark = LandmarkOf(reading, table);
  const bool is_right = reading.side == BodySide::kRight;
  const auto of_side = [&](const std::string& name) {
    return is_right && landmark.is_sided ? OnTheRight(name) : name;
  };
  const int segment = landmark.segment.empty() ? -1 : model.FindSegment(of_side(landmark.segment));
  if (segment >= 0) {
    ModelMarker place{"", segment, landmark.p_SM};
    if (is_right && landmark.is_sided) place.p_SM.x() = -place.p_SM.x();
    return place;
  }
  const int marker = landmark.marker.empty() ? -1 : model.FindMarker(of_side(landmark.marker));
  if (marker < 0) return std::nullopt;
  return model.markers()[static_cast<std::size_t>(marker)];
}

double NoiseScaleOf(const Landmark& landmark) {
  return std::max(kLeastNoiseScale, landmark.deviation / kModelDeviation);
}

NamedMarkers ComposeNamedMarkers(const std::vector<std::string>& labels,
                                 const std::vector<ReadLabel>& read, const KinematicModel& model,
                                 const LandmarkTable& table) {
  NamedMarkers named;
  named.set.name = "names";
  named.set.description = "composed of the names of the labels";
  std::set<std::string> taken;  // markers and labels, as the mapping compares them
  for (std::size_t i = 0; i < labels.size(); ++i) {
    NamedLabel& one = named.labels.emplace_back();
    one.label = labels[i];
    one.readings = read[i].readings;
    one.note = read[i].why_left_out;
    if (one.readings.empty()) continue;
    const LabelReading& reading = one.readings.front();
    const Landmark& landmark = LandmarkOf(reading, table);
    one.landmark = DescribeReading(reading, table);
    one.part = WithSide(landmark.part, reading.side);
    one.is_cluster = landmark.kind == LandmarkKind::kSegment;
    if (!one.note.empty()) continue;
    if (named.set.pairs.size() >= kMostWorn) {
      one.note = "a person wears fewer markers";
      continue;
    }
    one.lacks_side = landmark.is_sided && reading.side == BodySide::kNone;
    const auto place = one.lacks_side ? std::nullopt : PlaceOf(reading, table, model);
    if (!place || !taken.insert("label " + NormalizeLabel(one.label)).second) {
      one.note = one.lacks_side ? "the side is not known"
                 : place        ? "another label of that name"
                                : "the model has no place for it";
      continue;
    }
    const bool is_models =
        !one.is_cluster && !place->name.empty() && taken.insert(place->name).second;
    one.marker = is_models ? place->name : one.label;
    named.set.pairs.push_back({one.label, one.marker, NoiseScaleOf(landmark)});
    if (is_models) continue;
    const Segment& segment = model.segments()[static_cast<std::size_t>(place->segment)];
    named.set.places.push_back({one.label, segment.name, place->p_SM, 0});
  }
  return named;
}

NamedMarkers ComposeNamedMarkers(const MarkerLabels& labels, const KinematicModel& model,
                                 const LandmarkTable& table) {
  std::vector<ReadLabel> read = ReadLabels(labels.names, labels.seen, table);
  for (std::size_t i = 0; i < labels.seen.size(); ++i) {
    if (!labels.seen[i] && read[i].why_left_out.empty()) {
      read[i].why_left_out = "not seen in any frame";
    }
  }
  return ComposeNamedMarkers(labels.names, read, model, table);
}

NamedMarkers PairByLandmarks(const MarkerLabels& labels, const KinematicModel& model,
                             const LandmarkTable& table) {
  std::vector<std::string> markers;
  std::map<std::string, std::size_t> alike;
  for (const ModelMarker& marker : model.markers()) {
    alike.emplace(NormalizeLabel(marker.name), markers.size());
    markers.push_back(marker.name);
  }
  const std::vector<ReadLabel> meant = ReadLabels(markers, {}, table);
  const std::vector<ReadLabel> read = ReadLabels(labels.names, labels.seen, table);
  NamedMarkers named;
  named.set.name = "names";
  named.set.description = "labels and markers of the model that are named after the same landmarks";
  std::set<std::size_t> taken;
  const auto pair = [&](std::size_t marker, double noise_scale, NamedLabel* one) {
    if (!one->marker.empty() || !taken.insert(marker).second) return;
    one->marker = markers[marker];
    named.set.pairs.push_back({one->label, one->marker, noise_scale});
  };
  for (std::size_t i = 0; i < labels.names.size(); ++i) {
    NamedLabel& one = named.labels.emplace_back();
    one.label = labels.names[i];
    one.readings = read[i].readings;
    if (!one.readings.empty()) {
      const LabelReading& reading = one.readings.front();
      one.landmark = DescribeReading(reading, table);
      one.part = WithSide(LandmarkOf(reading, table).part, reading.side);
    }
    const auto found = alike.find(NormalizeLabel(one.label));
    if (found != alike.end()) pair(found->second, 1, &one);
  }
  for (NamedLabel& one : named.labels) {
    if (one.readings.empty()) continue;
    const LabelReading& reading = one.readings.front();
    const Landmark& landmark = LandmarkOf(reading, table);
    for (std::size_t m = 0; m < markers.size(); ++m) {
      const bool is_same = !meant[m].readings.empty() && meant[m].readings.front() == reading;
      // Where the model has its own markers nobody else's places count.
      const double noise_scale = std::max(1.0, NoiseScaleOf(landmark));
      if (is_same && landmark.kind != LandmarkKind::kSegment) pair(m, noise_scale, &one);
    }
    if (one.marker.empty()) one.note = "no marker of the model is named after it";
  }
  return named;
}

bool IsOfSet(const NamedMarkers& named, const MarkerSet& set) {
  constexpr double kLeastShare = 0.5;  // of the markers of a laboratory's set
  constexpr int kOneOf = 20;           // a label that nobody else has makes no other set
  std::set<std::string> known, targets, mapped;
  for (const MarkerPair& pair : set.pairs) known.insert(NormalizeLabel(pair.source));
  int others = 0;
  std::set<std::string> labels;
  for (const NamedLabel& one : named.labels) {
    const std::string label = NormalizeLabel(one.label);
    others += !one.marker.empty() && !known.contains(label);
    labels.insert(label);
  }
  for (const MarkerPair& pair : set.pairs) {
    if (pair.noise_scale != 1) return false;
    targets.insert(pair.target);
    if (labels.contains(NormalizeLabel(pair.source))) mapped.insert(pair.target);
  }
  const double least = set.file.empty() ? 0 : kLeastShare * static_cast<double>(targets.size());
  return kOneOf * others <= named.num_used() && static_cast<double>(mapped.size()) >= least;
}

}  // namespace mmm_converter
