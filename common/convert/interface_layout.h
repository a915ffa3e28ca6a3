// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace mmm_converter {

/// Of the sizes and alignments of types, as the compiler of this translation unit lays them out.
/// Options such as -march change these of Eigen's types and of all that hold them.
template <typename... Types>
constexpr std::uint32_t LayoutHash() {
  std::uint32_t hash = 2166136261U;  // FNV-1a
  const auto add = [&hash](std::size_t number) {
    hash = (hash ^ static_cast<std::uint32_t>(number)) * 16777619U;
  };
  ((add(sizeof(Types)), add(alignof(Types))), ...);
  return hash;
}

/// "name:0123abcd" with the hash, and a zero behind it.
template <std::size_t kSize>
constexpr std::array<char, kSize + 9> InterfaceText(const char (&name)[kSize], std::uint32_t hash) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::array<char, kSize + 9> text = {};
  for (std::size_t i = 0; i + 1 < kSize; ++i) text[i] = name[i];
  text[kSize - 1] = ':';
  for (std::size_t i = 0; i < 8; ++i) text[kSize + i] = kDigits[hash >> (28 - 4 * i) & 0xFU];
  return text;
}

}  // namespace mmm_converter
