// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "common/support/index.h"

namespace mmm_converter::testing {

/// 0, 1, ..., size - 1.
template <typename Ix>
std::vector<Ix> AllIndices(std::size_t size) {
  std::vector<Ix> indices;
  indices.reserve(size);
  for (std::size_t i = 0; i < size; ++i) indices.push_back(Ix(static_cast<int>(i)));
  return indices;
}

}  // namespace mmm_converter::testing
