// SPDX-License-Identifier: MIT
#include "common/convert/marker_mapping.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <set>

#include "common/io/recording/marker_labels.h"
#include "common/model/kinematic_model.h"
#include "common/motion/marker_sequence.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

std::string BareLabel(const std::string& label) {
  return NormalizeLabel(label.substr(label.rfind(':') + 1));
}

/// Index of the first label of each name.
std::map<std::string, int> IndicesByName(const std::vector<std::string>& names) {
  std::map<std::string, int> indices;
  for (std::size_t i = 0; i < names.size(); ++i) {
    indices.emplace(BareLabel(names[i]), static_cast<int>(i));
  }
  return indices;
}

bool IsEverSeen(const MarkerSequence& recording, int label) {
  for (int k = 0; k < recording.num_frames(); ++k) {
    if (IsSeen(recording.frame(k).col(label))) return true;
  }
  return false;
}

void CheckPairs(const std::vector<MarkerPair>& pairs, const KinematicModel& model) {
  std::vector<std::string> unknown;
  std::map<std::string, std::string> targets;
  for (const MarkerPair& pair : pairs) {
    if (model.FindMarker(pair.target) < 0) unknown.push_back(pair.target);
    const auto [it, is_new] = targets.emplace(BareLabel(pair.source), pair.target);
    if (!is_new && it->second != pair.target) {
      throw Error(fmt::format("marker mapping: label {} is mapped to both {} and {}", pair.source,
                              it->second, pair.target));
    }
  }
  if (unknown.empty()) return;
  std::vector<std::string> markers(model.markers().size());
  std::transform(model.markers().begin(), model.markers().end(), markers.begin(),
                 [](const ModelMarker& marker) { return marker.name; });
  throw Error(fmt::format("marker mapping: not markers of model {}: {}; it has: {}", model.name(),
                          FirstNames(unknown), FirstNames(markers)));
}

[[noreturn]] void ThrowNoMatch(const std::vector<MarkerPair>& pairs, const MarkerLabels& labels) {
  std::vector<std::string> sources;
  sources.reserve(pairs.size());
  for (const MarkerPair& pair : pairs) sources.push_back(pair.source);
  std::vector<std::string> unseen;
  for (const std::string& label : labels.names) {
    const bool is_mapped = std::any_of(
        sources.begin(), sources.end(),
        [&](const std::string& source) { return BareLabel(source) == BareLabel(label); });
    if (is_mapped) unseen.push_back(label);
  }
  if (!unseen.empty()) {
    throw Error(fmt::format("{}the labels that are mapped are seen in no frame: {}",
                            labels.source.empty() ? "" : labels.source + ": ", FirstNames(unseen)));
  }
  throw Error(fmt::format("{}no label of the recording is mapped: it has {}; the mapping has {}",
                          labels.source.empty() ? "" : labels.source + ": ",
                          labels.names.empty() ? "none" : FirstNames(labels.names),
                          sources.empty() ? "none" : FirstNames(sources)));
}

}  // namespace

MarkerLabels LabelsOf(const MarkerSequence& recording, const std::string& source) {
  MarkerLabels labels{recording.labels(), {}, source};
  for (int i = 0; i < recording.num_labels(); ++i) labels.seen.push_back(IsEverSeen(recording, i));
  return labels;
}

std::vector<LabelIx> LabelIndices(const std::vector<MarkerAssignment>& assignments) {
  std::vector<LabelIx> labels;
  labels.reserve(assignments.size());
  for (const MarkerAssignment& assignment : assignments) labels.push_back(assignment.label);
  return labels;
}

std::vector<MarkerIx> MarkerIndices(const std::vector<MarkerAssignment>& assignments) {
  std::vector<MarkerIx> markers;
  markers.reserve(assignments.size());
  for (const MarkerAssignment& assignment : assignments) markers.push_back(assignment.marker);
  return markers;
}

Eigen::VectorXd NoiseScales(const std::vector<MarkerAssignment>& assignments) {
  Eigen::VectorXd scales(assignments.size());
  for (std::size_t i = 0; i < assignments.size(); ++i) scales[i] = assignments[i].noise_scale;
  return scales;
}

MarkerMapping ResolveMarkerMapping(const std::vector<MarkerPair>& pairs, const MarkerLabels& labels,
                                   const KinematicModel& model, Warnings* warnings) {
  CheckPairs(pairs, model);
  const std::map<std::string, int> indices = IndicesByName(labels.names);
  MarkerMapping mapping;
  std::map<int, MarkerAssignment> by_marker;
  std::set<std::string> used;
  for (const MarkerPair& pair : pairs) {
    const int marker = model.FindMarker(pair.target);
    const auto label = indices.find(BareLabel(pair.source));
    if (label == indices.end() || by_marker.contains(marker)) continue;
    const std::string& name = labels.names[label->second];
    if (!labels.seen.empty() && !labels.seen[label->second]) {
      Warn(warnings, fmt::format("marker {} is not seen in any frame", name));
      continue;
    }
    by_marker[marker] = {LabelIx(label->second), MarkerIx(marker), pair.noise_scale};
    used.insert(name);
    if (!pair.warning.empty()) {
      Warn(warnings, fmt::format("{} as {}: {}", name, pair.target, pair.warning));
    }
  }
  if (by_marker.empty()) ThrowNoMatch(pairs, labels);

  for (const auto& [marker, assignment] : by_marker) mapping.assignments.push_back(assignment);
  for (const std::string& label : labels.names) {
    if (!used.contains(label)) mapping.ignored_labels.push_back(label);
  }
  std::set<std::string> absent;
  for (const MarkerPair& pair : pairs) {
    if (by_marker.contains(model.FindMarker(pair.target))) continue;
    if (absent.insert(pair.target).second) mapping.absent_markers.push_back(pair.target);
  }
  return mapping;
}

}  // namespace mmm_converter
