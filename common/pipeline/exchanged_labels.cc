// SPDX-License-Identifier: MIT
#include "common/pipeline/exchanged_labels.h"

#include <fmt/format.h>

#include "common/convert/exchanged_sides.h"
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

}  // namespace mmm_converter
