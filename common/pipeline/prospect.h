// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/convert/marker_mapping.h"
#include "common/pipeline/input/input.h"
#include "common/study/coverage.h"

namespace mmm_converter {

/// What a conversion of a recording, with defaults, would have to go by.
struct Prospect {
  std::string failure;     ///< why it can't be converted like that; empty: it can
  std::string marker_set;  ///< that it would be read with; empty: the configuration's own list
  MarkerMapping mapping;
  std::shared_ptr<const NamedMarkers> names;  ///< by which it would be read; null: by that set
  Person person;
  std::vector<Limb> limbs;
  std::vector<Gap> gaps;            ///< of more than a second
  std::vector<std::string> doubts;  ///< of unit and axis
};

/// Plans the conversion of a recording that was read before, and tracks nothing.
Prospect FindProspect(const InputRequest& request, std::shared_ptr<const Recording> recording);

}  // namespace mmm_converter
