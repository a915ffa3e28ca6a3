// SPDX-License-Identifier: MIT
#include <limits>

#include "common/pipeline/dynamics/dynamics_check.h"

namespace mmm_converter {

std::vector<Option> Options(DynamicsOptions* options) {
  constexpr double kAny = std::numeric_limits<double>::infinity();
  return {Row({"low-pass", "", "low_pass"}, {OptionKind::kNumber, "HZ", "hertz", 0, kAny},
              "cut-off before differentiation; 0: no filter, for smooth motions", "6",
              task::kCheckDynamics, &options->cutoff, {.absent = "a batch converts"}, "Recording")};
}

}  // namespace mmm_converter
