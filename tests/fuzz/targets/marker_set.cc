// SPDX-License-Identifier: MIT
#include "common/convert/marker_set.h"

#include "tests/fuzz/fuzz_target.h"
#include "tests/support/stick_model.h"

namespace mmm_converter::testing {

void ReadMarkerSetBytes(std::string_view bytes) {
  static const LoadedModel model = {StickModel(), true, {}};
  const MarkerSet set = ReadMarkerSet(FileOf(bytes));
  CountMappedMarkers(set, {"A", "B", "C", "D"});
  const KinematicModel placed = PlaceMarkers(set, model);
  Require(placed.markers().size() >= model.model.markers().size(), "the model's markers and more");
  Require(PairsInModel(set, placed).size() <= set.pairs.size() + set.places.size(),
          "pairs of the set only");
}

}  // namespace mmm_converter::testing
