// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/io/c3d/c3d_file.h"
#include "common/support/warnings.h"

namespace mmm_converter {

struct C3dEvent {
  double time = 0;      ///< [s] as those of markers: the capture's frame 1 is at 0
  std::string label;    ///< "Foot Strike"; header events have 4 letters at most
  std::string context;  ///< "Left", "Right", "General"; empty: not stated
  std::string subject;  ///< empty: not stated
  bool is_in_header = false;
};

/// The events of the group EVENT, then those of the header (18 at most), which can be the same
/// ones. What contradicts itself is left out and named in warnings.
std::vector<C3dEvent> ReadC3dEvents(const C3dFile& file, Warnings* warnings);

}  // namespace mmm_converter
