// SPDX-License-Identifier: MIT
#include "common/pipeline/prospect.h"

#include <utility>

#include "common/pipeline/conversion.h"
#include "common/support/advice.h"
#include "common/support/error.h"

namespace mmm_converter {

Prospect FindProspect(const InputRequest& request, std::shared_ptr<const Recording> recording) {
  Prospect prospect;
  ConversionRequest conversion;
  conversion.input = request;
  ReadBefore read_before;
  read_before.motion.value = std::move(recording);
  try {
    const ConversionPlan plan = PlanConversion(conversion, read_before);
    prospect.marker_set = plan.setup.marker_set;
    prospect.mapping = plan.setup.mapping;
    prospect.names = plan.input.names;
    prospect.person = plan.person;
    prospect.limbs = LimbsOf(plan.setup);
    for (const ReadingDoubt& doubt : plan.input.recording.doubts) {
      prospect.doubts.push_back(WithAdvice(doubt.text, doubt.remedy));
    }
    prospect.gaps = LongGaps(plan.setup, plan.input.recording.markers);
  } catch (const Error& error) {
    prospect.failure = WithAdvice(error);
  }
  return prospect;
}

}  // namespace mmm_converter
