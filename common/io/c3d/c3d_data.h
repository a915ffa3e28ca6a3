// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <vector>

#include "common/io/c3d/c3d_layout.h"

namespace mmm_converter {

/// Word 4 of a stored point.
struct C3dPointWord {
  bool valid = false;
  bool known = false;  ///< residual and cameras can be told
  int residual = 0;    ///< times scale
  int cameras = 0;
};

C3dPointWord DecodeC3dPointWord(const unsigned char* point, const C3dLayout& layout);

/// x, y, z of a stored point, scaled.
void DecodeC3dPosition(const unsigned char* point, const C3dLayout& layout, double* xyz);

/// False where a coordinate is not finite or beyond 1e6: some systems write 9999999 for a missing
/// marker.
inline bool IsC3dPosition(const double* xyz) {
  constexpr double kFarAway = 1e6;
  return std::abs(xyz[0]) <= kFarAway && std::abs(xyz[1]) <= kFarAway &&
         std::abs(xyz[2]) <= kFarAway;  // false for NaN as well
}

/// Chosen points of `frames` stored frames to 3 x points x frames numbers; unseen points become
/// NaN.
void DecodeC3dFrames(const unsigned char* stored, int frames, const std::vector<int>& points,
                     const C3dLayout& layout, bool ignore_residuals, double* xyz);

}  // namespace mmm_converter
