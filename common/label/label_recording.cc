// SPDX-License-Identifier: MIT
#include "common/label/label_recording.h"

#include "common/support/error.h"

namespace mmm_converter {

Labelling LabelRecording(const TrackingSetup& /*setup*/, const std::vector<std::string>& /*names*/,
                         const MarkerSequence& /*recording*/, const LabelOptions& /*options*/,
                         const std::function<bool(int, int)>& /*progress*/) {
  throw Error("labels can't be found yet");
}

}  // namespace mmm_converter
