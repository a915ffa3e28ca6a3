// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "common/math/kernel_variants.h"

namespace mmm_converter {

/// B(k, j) = data[k * row + j * col]: a matrix, a transposed one, or a part of one.
struct StridedFactor {
  const double* data = nullptr;
  std::ptrdiff_t row = 0;
  std::ptrdiff_t col = 0;
};

/// Which part of a product is not zero, or not asked for, by construction.
enum class Shape {
  kFull,
  kLowerResult,  ///< only C's lower triangle is asked for
  kUpperLeft,    ///< A is upper triangular
  kUpperRight,   ///< B is upper triangular
};

/// C (rows x cols) = beta C + alpha A W B with A (rows x depth), B (depth x cols) and a diagonal W.
struct DenseProduct {
  double alpha = 1;
  const double* A = nullptr;
  std::ptrdiff_t A_col = 0;  ///< distance of columns
  StridedFactor B;
  double beta = 0;
  double* C = nullptr;
  std::ptrdiff_t C_col = 0;
  int rows = 0;
  int cols = 0;
  int depth = 0;
  Shape shape = Shape::kFull;
  const double* W = nullptr;  ///< nullptr: the identity
};

/// Products and factorisations of small dense matrices, as dense.h uses them. Sizes are padded,
/// columns contiguous and aligned (PaddedMatrix).
struct DenseKernels {
  void (*multiply)(const DenseProduct& product);
  /// The lower triangle of A = G G^T becomes G, the rest 0.
  void (*factorize)(double* A, int size);
  /// X (rows x size) becomes X G^-T.
  void (*divide)(const double* G, int size, double* X, std::ptrdiff_t X_col, int rows);
  /// x becomes G^-1 x.
  void (*solve)(const double* G, int size, double* x);
  /// x becomes G^-T x.
  void (*solve_transposed)(const double* G, int size, double* x);
};

MMM_CONVERTER_DECLARE_KERNELS(DenseKernels)

}  // namespace mmm_converter
