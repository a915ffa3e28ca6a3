// SPDX-License-Identifier: MIT
#pragma once

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

}  // namespace mmm_converter
