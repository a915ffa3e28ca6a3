// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>

namespace mmm_converter {

inline constexpr std::uint64_t kBlock = 512;  ///< bytes; sections of a C3D file begin at multiples
inline constexpr int kFullWord = 65535;       ///< "more than a word can say"
inline constexpr std::uint64_t kBufferBytes = 1 << 20;  ///< that are read at once

/// How a C3D file stores numbers; the values are those of its processor byte.
enum class C3dProcessor {
  kIntel = 84,  ///< little endian, IEEE floats
  kDec = 85,    ///< little endian words, VAX F floats
  kMips = 86,   ///< big endian, IEEE floats
};

template <C3dProcessor kProcessor>
std::uint16_t C3dWord(const unsigned char* p) {
  if constexpr (kProcessor == C3dProcessor::kMips) {
    return static_cast<std::uint16_t>(p[0] << 8 | p[1]);
  } else {
    return static_cast<std::uint16_t>(p[1] << 8 | p[0]);
  }
}

template <C3dProcessor kProcessor>
float C3dFloat(const unsigned char* p) {
  const std::uint32_t a = C3dWord<kProcessor>(p);
  const std::uint32_t b = C3dWord<kProcessor>(p + 2);
  if constexpr (kProcessor == C3dProcessor::kDec) {
    // VAX F: the high half first, exponent bias 129 where IEEE has 127; no NaN, no infinity.
    const std::uint32_t bits = a << 16 | b;
    const std::uint32_t exponent = bits >> 23 & 0xFF;
    return exponent <= 2 ? 0.0F : std::bit_cast<float>(bits - (2U << 23));
  } else if constexpr (kProcessor == C3dProcessor::kMips) {
    return std::bit_cast<float>(a << 16 | b);
  } else {
    return std::bit_cast<float>(b << 16 | a);
  }
}

inline std::uint16_t C3dWord(const unsigned char* p, C3dProcessor processor) {
  return processor == C3dProcessor::kMips ? C3dWord<C3dProcessor::kMips>(p)
                                          : C3dWord<C3dProcessor::kIntel>(p);
}

inline float C3dFloat(const unsigned char* p, C3dProcessor processor) {
  switch (processor) {
    case C3dProcessor::kDec:
      return C3dFloat<C3dProcessor::kDec>(p);
    case C3dProcessor::kMips:
      return C3dFloat<C3dProcessor::kMips>(p);
    default:
      return C3dFloat<C3dProcessor::kIntel>(p);
  }
}

inline void StoreC3dWord(int word, C3dProcessor processor, unsigned char* p) {
  const bool is_big = processor == C3dProcessor::kMips;
  p[is_big ? 1 : 0] = static_cast<unsigned char>(word & 0xFF);
  p[is_big ? 0 : 1] = static_cast<unsigned char>(word >> 8 & 0xFF);
}

/// A finite number that is no larger than DEC's can be.
inline void StoreC3dFloat(float number, C3dProcessor processor, unsigned char* p) {
  auto bits = std::bit_cast<std::uint32_t>(number);
  if (processor == C3dProcessor::kDec && number != 0) bits += 2U << 23;
  const bool has_high_first = processor != C3dProcessor::kIntel;
  StoreC3dWord(static_cast<int>(bits >> (has_high_first ? 16 : 0) & 0xFFFF), processor, p);
  StoreC3dWord(static_cast<int>(bits >> (has_high_first ? 0 : 16) & 0xFFFF), processor, p + 2);
}

}  // namespace mmm_converter
