// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/convert/tracking_setup.h"
#include "common/label/track/label_options.h"
#include "common/label/track/labelling.h"
#include "common/label/track/object_tracks.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter {

/// Who and what may be among the points. A setup's labels and an object's names are indices of the
/// names of the labelling.
struct LabelScene {
  std::vector<TrackingSetup> persons;  ///< at least one; models calibrated or scaled by height
  std::vector<LabelObject> objects = {};
};

/// Names the points of a recording by the bodies that wear them. Objects are found first, by the
/// distances between their markers; what they leave is the persons', who share it frame by frame:
/// each point is offered to the one it is likelier to belong to. Several persons are looked for
/// where they stand apart, in one frame of the recording at least. Columns of the recording are
/// points whatever their labels say; a column may hold several markers one after the other.
/// progress(done, all) may be empty; returning false ends it with an Error.
/// @throws Error where a person has fewer than ten markers, or no frame shows enough points for
///         the bodies to be found.
Labelling LabelRecording(const LabelScene& scene, const std::vector<std::string>& names,
                         const MarkerSequence& recording, const LabelOptions& options,
                         const std::function<bool(int, int)>& progress);

}  // namespace mmm_converter
