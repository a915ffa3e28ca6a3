// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/version.h"

#include <fmt/core.h>

#include <vector>

#include "common/math/instruction_set.h"
#include "common/support/text.h"

namespace mmm_converter {

std::string VersionText() {
  std::vector<std::string> names;
  for (const InstructionSet set : SupportedInstructionSets()) names.push_back(ToString(set));
  return fmt::format(
      "MMMConverterS2KF " MMM_CONVERTER_VERSION
      "\ninstruction set {} (this processor has {}; MMM_CONVERTER_INSTRUCTION_SET chooses)\n"
      "built by " MMM_CONVERTER_COMPILER ", " MMM_CONVERTER_FEATURES
      "\n"
      "with " MMM_CONVERTER_LIBRARIES "\n",
      ToString(ActiveInstructionSet()), JoinNames(names, " and "));
}

}  // namespace mmm_converter
