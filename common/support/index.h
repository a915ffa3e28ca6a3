// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

namespace mmm_converter {

/// An index into the list that Tag names. Where an int is asked for it is one, but neither an int
/// nor the index of another list becomes one unsaid.
template <typename Tag>
class ListIndex {
 public:
  constexpr ListIndex() = default;  ///< -1: none
  constexpr explicit ListIndex(int value) : value_(value) {}
  constexpr operator int() const { return value_; }

 private:
  int value_ = -1;
};

/// 0, 1, ..., size - 1.
template <typename Ix>
std::vector<Ix> AllIndices(std::size_t size) {
  std::vector<Ix> indices;
  indices.reserve(size);
  for (std::size_t i = 0; i < size; ++i) indices.push_back(Ix(static_cast<int>(i)));
  return indices;
}

}  // namespace mmm_converter
