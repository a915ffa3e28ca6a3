// SPDX-License-Identifier: MIT
#include "common/io/c3d/c3d_data.h"

#include <cmath>
#include <cstdint>

#include "common/support/units.h"

namespace mmm_converter {
namespace {

/// Word 4 was made a float by the writer: back to the 16 bits that it was (65535 and -1 are the
/// same).
bool WordOfFloat(float stored, std::int16_t* word) {
  if (!(std::abs(stored) < 65536.0F)) return false;
  *word = static_cast<std::int16_t>(static_cast<std::int32_t>(stored) & 0xFFFF);
  return true;
}

template <C3dProcessor kProcessor, bool kFloats>
bool IsMarkedValid(const unsigned char* point) {
  if constexpr (kFloats) {
    const float stored = C3dFloat<kProcessor>(point + 12);
    std::int16_t word = 0;
    // Huge but finite: bits that were never converted; the point is good, its residual is not
    // known.
    return WordOfFloat(stored, &word) ? word >= 0 : std::isfinite(stored);
  } else {
    return static_cast<std::int16_t>(C3dWord<kProcessor>(point + 6)) >= 0;
  }
}

template <C3dProcessor kProcessor, bool kFloats>
void Position(const unsigned char* point, double scale, double* xyz) {
  for (int i = 0; i < 3; ++i) {
    if constexpr (kFloats) {
      xyz[i] = C3dFloat<kProcessor>(point + 4 * i);
    } else {
      xyz[i] = scale * static_cast<std::int16_t>(C3dWord<kProcessor>(point + 2 * i));
    }
  }
}

template <C3dProcessor kProcessor, bool kFloats>
void DecodeFrames(const unsigned char* stored, int frames, const std::vector<int>& points,
                  const C3dLayout& layout, bool ignore_residuals, double* xyz) {
  constexpr int kPointBytes = kFloats ? 16 : 8;
  for (int k = 0; k < frames; ++k, stored += layout.frame_bytes) {
    for (const int index : points) {
      const unsigned char* point = stored + static_cast<std::size_t>(index) * kPointBytes;
      Position<kProcessor, kFloats>(point, layout.scale, xyz);
      const bool zero = xyz[0] == 0 && xyz[1] == 0 && xyz[2] == 0;
      const bool valid = ignore_residuals || IsMarkedValid<kProcessor, kFloats>(point);
      if (!IsC3dPosition(xyz) || zero || !valid) xyz[0] = xyz[1] = xyz[2] = kNaN;
      xyz += 3;
    }
  }
}

template <bool kFloats>
void DecodeFrames(const unsigned char* stored, int frames, const std::vector<int>& points,
                  const C3dLayout& layout, bool ignore, double* xyz) {
  switch (layout.processor) {
    case C3dProcessor::kIntel:
      return DecodeFrames<C3dProcessor::kIntel, kFloats>(stored, frames, points, layout, ignore,
                                                         xyz);
    case C3dProcessor::kDec:
      return DecodeFrames<C3dProcessor::kDec, kFloats>(stored, frames, points, layout, ignore, xyz);
    case C3dProcessor::kMips:
      return DecodeFrames<C3dProcessor::kMips, kFloats>(stored, frames, points, layout, ignore,
                                                        xyz);
  }
}

}  // namespace

C3dPointWord DecodeC3dPointWord(const unsigned char* point, const C3dLayout& layout) {
  C3dPointWord decoded;
  std::int16_t word = 0;
  if (layout.floats) {
    const float stored = C3dFloat(point + 12, layout.processor);
    decoded.known = WordOfFloat(stored, &word);
    decoded.valid = decoded.known ? word >= 0 : std::isfinite(stored);
  } else {
    word = static_cast<std::int16_t>(C3dWord(point + 6, layout.processor));
    decoded.known = true;
    decoded.valid = word >= 0;
  }
  decoded.residual = word & 0xFF;
  decoded.cameras = word >> 8 & 0x7F;
  return decoded;
}

void DecodeC3dPosition(const unsigned char* point, const C3dLayout& layout, double* xyz) {
  for (int i = 0; i < 3; ++i) {
    xyz[i] =
        layout.floats
            ? C3dFloat(point + 4 * i, layout.processor)
            : layout.scale * static_cast<std::int16_t>(C3dWord(point + 2 * i, layout.processor));
  }
}

void DecodeC3dFrames(const unsigned char* stored, int frames, const std::vector<int>& points,
                     const C3dLayout& layout, bool ignore_residuals, double* xyz) {
  if (layout.floats) {
    DecodeFrames<true>(stored, frames, points, layout, ignore_residuals, xyz);
  } else {
    DecodeFrames<false>(stored, frames, points, layout, ignore_residuals, xyz);
  }
}

}  // namespace mmm_converter
