// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/io/osim/osim_document.h"

namespace mmm_converter {

/// Bodies that have one size together, as nothing could tell their sizes apart: those that no joint
/// moves against each other, and those without markers, which go with what they carry, or else with
/// what carries them (a talus with its foot, a patella with its femur).
struct OsimSizes {
  std::vector<int> size_of;                 ///< by body; -1: no marker tells it (ground)
  std::vector<int> bodies;                  ///< of each size, the first that has a marker
  std::vector<std::pair<int, int>> mirror;  ///< of sizes: left and right
};

/// has_marker: by body of the document.
OsimSizes FindOsimSizes(const OsimDocument& document, const std::vector<bool>& has_marker);

}  // namespace mmm_converter
