// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

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

}  // namespace mmm_converter
