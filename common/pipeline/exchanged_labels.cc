// SPDX-License-Identifier: MIT
#include "common/pipeline/exchanged_labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "common/convert/exchanged_sides.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {

std::optional<MarkerSequence> ExchangeSides(TrackingSetup setup, const std::vector<LabelIx>& stored,
                                            const MarkerSequence& recording, Warnings* warnings) {
  std::vector<MarkerAssignment>& assignments = setup.mapping.assignments;
  for (MarkerAssignment& one : assignments) one.label = stored[one.label];
  std::erase_if(assignments, [](const MarkerAssignment& one) { return one.label < 0; });
  const auto sides = FindExchangedSides(setup, recording);
  if (!sides) return std::nullopt;
  warnings->Add(fmt::format(
      "left and right labels of {} are exchanged, by which markers come from {:.0f} to {:.0f} mm "
      "from the model; if it is the coordinates that are mirrored, mend these instead",
      sides->part, kMillimetres * sides->distance, kMillimetres * sides->exchanged_distance));
  return WithLabelsExchanged(*sides, recording);
}

std::optional<MarkerSequence> ExchangeNames(const NamedMarkers& named,
                                            const NamedMarkers& understood,
                                            const MarkerSequence& recording, Warnings* warnings) {
  NamedMarkers exchanged;
  std::map<int, int> name_of;  // by label, the one whose name it gets
  for (int i = 0; i < static_cast<int>(understood.labels.size()); ++i) {
    const NamedLabel& one = understood.labels[i];
    if (!one.is_contradicted || one.marker.empty()) continue;
    const auto owner =
        std::find_if(named.labels.begin(), named.labels.end(), [&](const NamedLabel& other) {
          return !other.marker.empty() && other.landmark == one.landmark;
        });
    if (owner != named.labels.end()) name_of[i] = static_cast<int>(owner - named.labels.begin());
  }
  // A name that its own label keeps is not free.
  while (std::erase_if(name_of, [&](const auto& one) { return !name_of.contains(one.second); })) {
  }
  std::vector<std::string> labels = recording.labels();
  for (const auto& [label, name] : name_of) {
    labels[label] = recording.labels()[name];
    if (label != name) exchanged.labels.push_back(understood.labels[label]);
  }
  const bool is_twice = std::set(labels.begin(), labels.end()).size() < labels.size();
  if (exchanged.labels.empty() || is_twice) return std::nullopt;
  warnings->Add(
      fmt::format("labels that are not where their names say get the names of where they are: {}",
                  FirstNames(DescribeContradictions(exchanged), 6)));
  MarkerSequence renamed(labels, recording.num_frames(), recording.rate(), recording.first_time());
  for (int k = 0; k < recording.num_frames(); ++k) renamed.frame(k) = recording.frame(k);
  return renamed;
}

}  // namespace mmm_converter
