// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/convert/tracking_setup.h"
#include "common/label/labelling.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter {

struct LabelOptions {
  /// A recording's own label per name, where it is to be believed unless the body surely says
  /// otherwise (repair); empty, or -1: none.
  std::vector<LabelIx> stored = {};
  /// Names less probable are not given.
  double least_probability = 0.4;
  /// Nor do they take the place of another one that is stored.
  double least_change_probability = 0.8;
};

/// Names the points of a recording by the body that wears them. setup: of the names, as if they
/// were a recording's labels; its model is the person's, calibrated or scaled by height. Columns of
/// the recording are points whatever their labels say; a column may hold several markers one after
/// the other. progress(done, all) may be empty; returning false ends it with an Error.
/// @throws Error where the setup has fewer than ten markers, or no frame shows enough points for
///         the body to be found.
Labelling LabelRecording(const TrackingSetup& setup, const std::vector<std::string>& names,
                         const MarkerSequence& recording, const LabelOptions& options,
                         const std::function<bool(int, int)>& progress);

}  // namespace mmm_converter
