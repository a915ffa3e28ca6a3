// SPDX-License-Identifier: MIT
#include "common/convert/marker_set.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "common/io/bytes/file_content.h"
#include "common/io/recording/marker_labels.h"
#include "common/io/xml/xml_document.h"
#include "common/model/kinematic_model.h"
#include "common/support/diagnostics.h"
#include "common/support/error.h"
#include "common/support/folder.h"
#include "common/support/suggestion.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr double kMinNoiseScale = 0.01;
constexpr double kMaxNoiseScale = 100;
constexpr double kFarthestPlace = 10;  // [m]; no segment is longer

void CheckAttributes(const XmlElement& element, const std::vector<std::string>& allowed,
                     Diagnostics* diagnostics) {
  for (const auto& attribute : element.attributes) {
    const std::string& key = attribute.first;
    if (std::any_of(allowed.begin(), allowed.end(),
                    [&](const std::string& name) { return EqualIgnoringCase(name, key); })) {
      continue;
    }
    diagnostics->AddError(element.line, fmt::format("<{}> has no attribute {}; allowed are {}",
                                                    element.name, key, fmt::join(allowed, ", ")));
  }
}

std::string Required(const XmlElement& element, const char* attribute, Diagnostics* diagnostics) {
  const std::string* value = element.FindAttribute(attribute);
  if (value != nullptr && !Trim(*value).empty()) return std::string(Trim(*value));
  diagnostics->AddError(element.line,
                        fmt::format("<{}> needs the attribute {}", element.name, attribute));
  return "";
}

MarkerPair ReadMapping(const XmlElement& element, Diagnostics* diagnostics) {
  CheckAttributes(element, {"source", "target", "noiseScale", "warning"}, diagnostics);
  MarkerPair pair;
  pair.source = Required(element, "source", diagnostics);
  pair.target = Required(element, "target", diagnostics);
  if (const std::string* text = element.FindAttribute("noiseScale")) {
    pair.noise_scale = ParseDouble(*text).value_or(0);
    if (!(pair.noise_scale >= kMinNoiseScale && pair.noise_scale <= kMaxNoiseScale)) {
      diagnostics->AddError(element.line,
                            fmt::format("noiseScale=\"{}\": must be a number from {} to {}", *text,
                                        kMinNoiseScale, kMaxNoiseScale));
    }
  }
  if (const std::string* text = element.FindAttribute("warning")) pair.warning = *text;
  return pair;
}

double Millimetres(const XmlElement& element, const char* attribute, Diagnostics* diagnostics) {
  constexpr double kMetresPerMillimetre = 1e-3;
  const std::string text = Required(element, attribute, diagnostics);
  const double value = kMetresPerMillimetre * ParseDouble(text).value_or(NAN);
  if (!text.empty() && !(std::abs(value) <= kFarthestPlace)) {
    diagnostics->AddError(element.line, fmt::format("{}=\"{}\": must be a number of mm, at most {}",
                                                    attribute, text, 1e3 * kFarthestPlace));
  }
  return value;
}

MarkerPlace ReadPlace(const XmlElement& element, Diagnostics* diagnostics) {
  CheckAttributes(element, {"name", "segment", "x_mm", "y_mm", "z_mm"}, diagnostics);
  MarkerPlace place;
  place.marker = Required(element, "name", diagnostics);
  place.segment = Required(element, "segment", diagnostics);
  place.p_SM.x() = Millimetres(element, "x_mm", diagnostics);
  place.p_SM.y() = Millimetres(element, "y_mm", diagnostics);
  place.p_SM.z() = Millimetres(element, "z_mm", diagnostics);
  place.line = element.line;
  return place;
}

/// A placed marker without a label of its own is labelled by its name.
void AddOwnLabels(MarkerSet* set) {
  std::set<std::string> labels;
  std::set<std::string> targets;
  for (const MarkerPair& pair : set->pairs) {
    labels.insert(NormalizeLabel(pair.source));
    targets.insert(pair.target);
  }
  for (const MarkerPlace& place : set->places) {
    const bool is_free = labels.insert(NormalizeLabel(place.marker)).second;
    if (is_free && !targets.contains(place.marker))
      set->pairs.push_back({place.marker, place.marker});
  }
}

/// -1: none.
int FindSegment(const LoadedModel& model, const std::string& name) {
  const auto link = model.segment_of_link.find(name);
  return model.model.FindSegment(link == model.segment_of_link.end() ? name : link->second);
}

/// Model markers that the set finds a label for, with the noise scale of the pair used.
std::map<std::string, double> MappedMarkers(const MarkerSet& set,
                                            const std::vector<std::string>& names) {
  std::set<std::string> labels;
  for (const std::string& name : names) labels.insert(NormalizeLabel(name));
  std::map<std::string, double> mapped;
  for (const MarkerPair& pair : set.pairs) {
    if (labels.contains(NormalizeLabel(pair.source))) mapped.emplace(pair.target, pair.noise_scale);
  }
  return mapped;
}

std::vector<std::string> NamesOfSegments(const LoadedModel& model) {
  std::vector<std::string> names;
  for (const Segment& segment : model.model.segments()) names.push_back(segment.name);
  for (const auto& [link, unused] : model.segment_of_link) names.push_back(link);
  return names;
}

}  // namespace

MarkerSet ReadMarkerSet(const std::string& path) {
  const std::string content = ReadFileContent(path);
  for (MarkerSetParser* const parse : PartMarkerSetParsers()) {
    if (std::optional<MarkerSet> set = parse(content, path)) return std::move(*set);
  }
  const XmlElement root = ParseXml(content, path);
  Diagnostics diagnostics(path);
  MarkerSet set;
  set.file = path;
  if (!root.Is("MarkerSet")) {
    diagnostics.AddError(root.line,
                         fmt::format("<{}>: expected <MarkerSet name=\"...\">", root.name));
    diagnostics.ThrowIfErrors();
  }
  CheckAttributes(root, {"name", "description"}, &diagnostics);
  set.name = Required(root, "name", &diagnostics);
  if (const std::string* text = root.FindAttribute("description")) set.description = *text;
  std::map<std::string, std::string> targets;
  std::set<std::string> placed;
  for (const XmlElement& child : root.children) {
    if (child.Is("Marker")) {
      set.places.push_back(ReadPlace(child, &diagnostics));
      if (!placed.insert(set.places.back().marker).second) {
        diagnostics.AddError(child.line,
                             fmt::format("marker {} is placed twice", set.places.back().marker));
      }
      continue;
    }
    if (!child.Is("Mapping")) {
      diagnostics.AddError(
          child.line,
          fmt::format("<{}>: only <Mapping> and <Marker> are allowed here", child.name));
      continue;
    }
    MarkerPair pair = ReadMapping(child, &diagnostics);
    if (!targets.emplace(NormalizeLabel(pair.source), pair.target).second) {
      diagnostics.AddError(child.line, fmt::format("label {} is mapped twice", pair.source));
    }
    set.pairs.push_back(std::move(pair));
  }
  if (set.pairs.empty() && set.places.empty()) {
    diagnostics.AddError(root.line, "the set has no <Mapping> and no <Marker>");
  }
  diagnostics.ThrowIfErrors();
  AddOwnLabels(&set);
  return set;
}

std::vector<MarkerSet> ReadMarkerSets(const std::string& folder) {
  const std::vector<std::string> files = FilesIn(folder, ".xml");
  if (files.empty()) throw Error(fmt::format("{}: there are no marker sets (*.xml) here", folder));
  std::vector<MarkerSet> sets;
  sets.reserve(files.size());
  for (const std::string& file : files) sets.push_back(ReadMarkerSet(file));
  return sets;
}

KinematicModel PlaceMarkers(const MarkerSet& set, const LoadedModel& model) {
  const KinematicModel& bare = model.model;
  ModelDescription description = DescriptionOf(bare);
  Diagnostics diagnostics(set.file);
  for (const MarkerPlace& place : set.places) {
    const int segment = FindSegment(model, place.segment);
    if (segment < 0) {
      const std::string closest =
          diagnostics.is_full() ? "" : ClosestName(place.segment, NamesOfSegments(model));
      diagnostics.AddError(
          place.line, fmt::format("marker {}: model {} has no segment \"{}\"{}", place.marker,
                                  bare.name(), place.segment,
                                  closest.empty() ? "; `MMMConverterS2KF info MODEL` lists them"
                                                  : " (did you mean " + closest + "?)"));
      continue;
    }
    const int marker = bare.FindMarker(place.marker);
    ModelMarker& placed = marker < 0 ? description.markers.emplace_back()
                                     : description.markers[static_cast<std::size_t>(marker)];
    placed = {place.marker, segment, place.p_SM};
  }
  diagnostics.ThrowIfErrors();
  return KinematicModel(std::move(description));
}

MarkerSet OwnMarkerSet(const KinematicModel& model) {
  MarkerSet set;
  set.name = "the model's own";
  set.pairs.reserve(model.markers().size());
  for (const ModelMarker& marker : model.markers()) set.pairs.push_back({marker.name, marker.name});
  return set;
}

std::vector<MarkerPair> PairsInModel(const MarkerSet& set, const KinematicModel& model) {
  std::vector<MarkerPair> pairs;
  std::copy_if(set.pairs.begin(), set.pairs.end(), std::back_inserter(pairs),
               [&](const MarkerPair& pair) { return model.FindMarker(pair.target) >= 0; });
  return pairs;
}

int CountMappedMarkers(const MarkerSet& set, const std::vector<std::string>& labels) {
  return static_cast<int>(MappedMarkers(set, labels).size());
}

const MarkerSet* FindMarkerSet(const std::vector<MarkerSet>& sets, const MarkerLabels& labels) {
  const MarkerSet* best = nullptr;
  std::size_t most = 0;
  double least_noise = 0;
  for (const MarkerSet& set : sets) {
    const std::map<std::string, double> mapped = MappedMarkers(set, labels.names);
    double noise = 0;
    for (const auto& [target, scale] : mapped) noise += scale;
    if (mapped.size() < 3 || mapped.size() < most) continue;
    if (mapped.size() == most && noise >= least_noise) continue;
    best = &set;
    most = mapped.size();
    least_noise = noise;
  }
  return best;
}

const MarkerSet& ChooseMarkerSet(const std::vector<MarkerSet>& sets, const MarkerLabels& labels) {
  if (const MarkerSet* const best = FindMarkerSet(sets, labels)) return *best;
  std::vector<std::string> names;
  names.reserve(sets.size());
  for (const MarkerSet& set : sets) names.push_back(set.name);
  throw Error(
      fmt::format(
          "{}no marker set ({}) knows three labels of the recording, which has {}; "
          "name links of a URDF <label>_marker, or say which labels stand for which markers "
          "and where these are, in the configuration or in a marker set",
          labels.source.empty() ? "" : labels.source + ": ", fmt::join(names, ", "),
          FirstNames(labels.names)),
      Remedy::kMarkerSet);
}

}  // namespace mmm_converter
