// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/conversion/prospect.h"

#include "MMMConverterS2KF/conversion/conversion.h"
#include "common/support/error.h"

namespace mmm_converter {

Prospect FindProspect(const InputRequest& request) {
  constexpr double kLongGap = 1;  // [s]
  Prospect prospect;
  ConversionRequest conversion;
  conversion.input = request;
  try {
    const ConversionPlan plan = PlanConversion(conversion, {});
    const MarkerSequence& markers = plan.input.recording.markers;
    prospect.marker_set = plan.setup.marker_set;
    prospect.mapping = plan.setup.mapping;
    prospect.person = plan.person;
    prospect.limbs = LimbsOf(plan.setup);
    prospect.doubts = plan.input.recording.doubts;
    for (const Gap& gap : LongestGaps(plan.setup, markers)) {
      const double seconds = (gap.last_frame - gap.first_frame + 1) / markers.rate();
      if (seconds > kLongGap) prospect.gaps.push_back(gap);
    }
  } catch (const Error& error) {
    prospect.failure = error.what();
  }
  return prospect;
}

}  // namespace mmm_converter
