// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "common/math/kernel_variants.h"

namespace mmm_converter::s2kf {

/// Where the roots of all sample pairs go: base +- offset. All columns have `rows` entries, of the
/// results the plus half first, then the minus half.
struct RootPlacement {
  bool is_rpy;            ///< the orientation is roll, pitch, yaw; else a vector w: R = R0 Exp(w)
  const double* R0;       ///< row-major, 9
  const double* base;     ///< position [m], then the orientation parameters, 6
  const double* offsets;  ///< 6 columns
  double* position;       ///< 3 columns of 2 rows
  double* rotation;       ///< 9 columns of 2 rows: R_WS row by row
  std::ptrdiff_t rows;
};

/// What a column of measurements z+- = z0 + e +- o says of its coordinate. No sum cancels.
struct PairSums {
  double even;     ///< sum of e [m]
  double squares;  ///< sum of e^2 + o^2 [m^2]
};

struct SampleKernels {
  void (*place_roots)(const RootPlacement& placement);
  /// Joint angles [rad]: plus, minus = middle + a cos(offset) +- b sin(offset).
  void (*place_angles)(double middle, double a, double b, const double* offsets, double* plus,
                       double* minus, int rows);
  /// plus becomes o, minus becomes e.
  PairSums (*fold)(double z0, double* plus, double* minus, int rows);
};

MMM_CONVERTER_DECLARE_KERNELS(SampleKernels)

}  // namespace mmm_converter::s2kf
