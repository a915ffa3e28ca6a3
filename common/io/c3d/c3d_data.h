// SPDX-License-Identifier: MIT
#pragma once

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

/// Chosen points of `frames` stored frames to 3 x points x frames numbers; unseen points become
/// NaN.
void DecodeC3dFrames(const unsigned char* stored, int frames, const std::vector<int>& points,
                     const C3dLayout& layout, bool ignore_residuals, double* xyz);

}  // namespace mmm_converter
