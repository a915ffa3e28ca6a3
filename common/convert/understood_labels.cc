// SPDX-License-Identifier: MIT
#include "common/convert/understood_labels.h"

#include <algorithm>
#include <optional>

#include "common/convert/name_judge.h"

namespace mmm_converter {
namespace {

/// The labels as they were read, those of a limb without side being of a side.
NamedMarkers OfSide(const NamedMarkers& named, BodySide side, const KinematicModel& reference,
                    const LandmarkTable& table) {
  std::vector<std::string> labels;
  std::vector<ReadLabel> read;
  for (const NamedLabel& one : named.labels) {
    labels.push_back(one.label);
    read.push_back({one.readings, one.lacks_side ? "" : one.note});
    if (!one.lacks_side) continue;
    for (LabelReading& reading : read.back().readings) reading.side = side;
  }
  return ComposeNamedMarkers(labels, read, reference, table);
}

/// Returns MeanDistance; nothing where no frame shows enough.
std::optional<double> Judge(const KinematicModel& reference, const MarkerSequence& recording,
                            const LandmarkTable& table, const NameOptions& options,
                            NamedMarkers* named) {
  NameJudge judge(reference, options.joints, recording, table, named);
  if (!judge.has_frames()) return std::nullopt;
  judge.Run(options.places_clusters);
  const double distance = judge.MeanDistance();
  judge.Compose();
  return distance;
}

}  // namespace

NamedMarkers UnderstandLabels(const MarkerLabels& labels, const MarkerSequence& recording,
                              const KinematicModel& reference, const LandmarkTable& table,
                              const NameOptions& options) {
  NamedMarkers named = ComposeNamedMarkers(labels, reference, table);
  if (!named.are_of_one_side()) {
    Judge(reference, recording, table, options, &named);
    return named;
  }
  NamedMarkers left = OfSide(named, BodySide::kLeft, reference, table);
  NamedMarkers right = OfSide(named, BodySide::kRight, reference, table);
  const auto by_left = Judge(reference, recording, table, options, &left);
  const auto by_right = Judge(reference, recording, table, options, &right);
  if (!by_left || !by_right) return named;
  return *by_left < *by_right ? left : right;
}

}  // namespace mmm_converter
