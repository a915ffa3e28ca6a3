// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>

#include "common/motion/marker_sequence.h"
#include "plugins/s2kf/s2kf_settings.h"
#include "plugins/s2kf/tracked_markers.h"

namespace mmm_converter::s2kf {

/// What one run over a whole recording tells before it is tracked.
struct FirstLook {
  /// Where the markers are worn, with settings.learn_places.
  std::optional<WornPlaces> places;
  /// With settings.choose_process_noise_scale: the factor on the process noise, beside
  /// settings.process_noise_scale, under which a filter expects the recording most: the least one
  /// that locally maximises the likelihood of the innovations, the sum of -(NIS + log det S) / 2
  /// over up to 480 frames from all parts of the recording (Mehra 1970), of the filter with a
  /// Jacobian. Within 1e-3 and 1e3; 1 where fewer than ten frames can be judged.
  std::optional<double> process_noise_scale;
};

/// progress(0) is asked frame by frame, may be empty.
/// @throws Error where it returns false.
FirstLook LookOver(const MarkerSequence& recording, const TrackedMarkers& markers,
                   const S2kfSettings& settings, const std::function<bool(int)>& progress);

}  // namespace mmm_converter::s2kf
