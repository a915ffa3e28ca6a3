// SPDX-License-Identifier: MIT
#include "common/math/dense_kernels.h"

#include "common/math/lanes.h"

namespace mmm_converter::MMM_CONVERTER_VARIANT {
namespace {

// A tile of C stays in registers: kTileRows vectors by kTileCols columns.
constexpr int kTileRows = 3;
constexpr int kTileCols = kLanes == 8 ? 8 : 4;
constexpr int kBlock = 8;  // columns that are factorised at once; all sizes are multiples of it

/// The part of C at (i, j), from the columns [begin, end) of A.
template <int kRows, bool kIsWeighted>
void MultiplyTile(const DenseProduct& p, int i, int j, int begin, int end) {
  Lanes sum[kTileCols][kRows] = {};
  const double* A = p.A + i + begin * p.A_col;
  const double* B = p.B.data + j * p.B.col + begin * p.B.row;
  for (int k = begin; k < end; ++k) {
    Lanes a[kRows];
    for (int r = 0; r < kRows; ++r) {
      a[r] = LoadLanes(A + r * kLanes);
      if constexpr (kIsWeighted) a[r] *= p.W[k];
    }
    for (int c = 0; c < kTileCols; ++c) {
      const double factor = B[c * p.B.col];
      for (int r = 0; r < kRows; ++r) sum[c][r] += a[r] * factor;
    }
    A += p.A_col;
    B += p.B.row;
  }
  double* C = p.C + j * p.C_col + i;
  for (int c = 0; c < kTileCols; ++c) {
    for (int r = 0; r < kRows; ++r) {
      Lanes result = p.alpha * sum[c][r];
      if (p.beta != 0) result += p.beta * LoadLanes(C + r * kLanes);
      StoreLanes(result, C + r * kLanes);
    }
    C += p.C_col;
  }
}

template <bool kIsWeighted>
void MultiplyTiles(const DenseProduct& p) {
  const bool is_upper_left = p.shape == Shape::kUpperLeft;
  for (int j = 0; j < p.cols; j += kTileCols) {
    const int triangle = j + kTileCols;
    const int end = p.shape == Shape::kUpperRight && triangle < p.depth ? triangle : p.depth;
    int i = p.shape == Shape::kLowerResult ? j / kLanes * kLanes : 0;
    for (; i + kTileRows * kLanes <= p.rows; i += kTileRows * kLanes) {
      MultiplyTile<kTileRows, kIsWeighted>(p, i, j, is_upper_left ? i : 0, end);
    }
    for (; i < p.rows; i += kLanes) {
      MultiplyTile<1, kIsWeighted>(p, i, j, is_upper_left ? i : 0, end);
    }
  }
}

void Multiply(const DenseProduct& product) {
  if (product.depth == 0 && product.beta == 1) return;
  if (product.W == nullptr) {
    MultiplyTiles<false>(product);
  } else {
    MultiplyTiles<true>(product);
  }
}

/// One over a pivot; a pivot that is 0, or that rounding made negative, counts as infinite: its
/// column of the factor becomes 0.
double Inverse(double pivot) { return pivot > 0 ? 1 / pivot : 0; }

/// X (rows x kBlock) becomes X D^-T, D being the block of G on its diagonal.
void DivideByBlock(const double* D, std::ptrdiff_t D_col, double* X, std::ptrdiff_t X_col,
                   int rows) {
  double inverse[kBlock];
  for (int j = 0; j < kBlock; ++j) inverse[j] = Inverse(D[j * D_col + j]);
  for (int i = 0; i < rows; i += kLanes) {
    Lanes x[kBlock];
    for (int j = 0; j < kBlock; ++j) x[j] = LoadLanes(X + j * X_col + i);
    for (int j = 0; j < kBlock; ++j) {
      x[j] *= inverse[j];
      for (int k = j + 1; k < kBlock; ++k) x[k] -= D[j * D_col + k] * x[j];
    }
    for (int j = 0; j < kBlock; ++j) StoreLanes(x[j], X + j * X_col + i);
  }
}

void FactorizeBlock(double* D, std::ptrdiff_t D_col) {
  for (int j = 0; j < kBlock; ++j) {
    double* column = D + j * D_col;
    const double pivot = column[j] > 0 ? __builtin_sqrt(column[j]) : 0;
    const double inverse = Inverse(pivot);
    column[j] = pivot;
    for (int i = 0; i < j; ++i) column[i] = 0;
    for (int i = j + 1; i < kBlock; ++i) column[i] *= inverse;
    for (int k = j + 1; k < kBlock; ++k) {
      for (int i = k; i < kBlock; ++i) D[k * D_col + i] -= column[k] * column[i];
    }
  }
}

// Left-looking: a block of columns is freed of what stands left of it, then factorised.
void Factorize(double* A, int size) {
  const std::ptrdiff_t stride = size;
  for (int j = 0; j < size; j += kBlock) {
    double* diagonal = A + j * stride + j;
    const StridedFactor left = {A + j, stride, 1};
    Multiply({-1, A + j, stride, left, 1, diagonal, stride, size - j, kBlock, j});
    FactorizeBlock(diagonal, stride);
    DivideByBlock(diagonal, stride, diagonal + kBlock, stride, size - j - kBlock);
    for (int k = 0; k < kBlock; ++k) {
      for (int i = 0; i < j; ++i) A[(j + k) * stride + i] = 0;
    }
  }
}

void Divide(const double* G, int size, double* X, std::ptrdiff_t X_col, int rows) {
  const std::ptrdiff_t stride = size;
  for (int j = 0; j < size; j += kBlock) {
    double* X_j = X + j * X_col;
    const StridedFactor left = {G + j, stride, 1};
    Multiply({-1, X, X_col, left, 1, X_j, X_col, rows, kBlock, j});
    DivideByBlock(G + j * stride + j, stride, X_j, X_col, rows);
  }
}

void Solve(const double* G, int size, double* x) {
  for (int j = 0; j < size; ++j) {
    const double* column = G + static_cast<std::ptrdiff_t>(j) * size;
    const double value = x[j] * Inverse(column[j]);
    // The part of the column above the diagonal is 0.
    for (int i = j / kLanes * kLanes; i < size; i += kLanes) {
      StoreLanes(LoadLanes(x + i) - value * LoadLanes(column + i), x + i);
    }
    x[j] = value;
  }
}

void SolveTransposed(const double* G, int size, double* x) {
  for (int j = size - 1; j >= 0; --j) {
    const double* column = G + static_cast<std::ptrdiff_t>(j) * size;
    const double own = x[j];
    x[j] = 0;
    Lanes sum = {};
    for (int i = j / kLanes * kLanes; i < size; i += kLanes) {
      sum += LoadLanes(column + i) * LoadLanes(x + i);
    }
    double known = 0;
    for (int lane = 0; lane < kLanes; ++lane) known += sum[lane];
    x[j] = (own - known) * Inverse(column[j]);
  }
}

}  // namespace

const DenseKernels& GetDenseKernels() {
  static constexpr DenseKernels kKernels = {Multiply, Factorize, Divide, Solve, SolveTransposed};
  return kKernels;
}

}  // namespace mmm_converter::MMM_CONVERTER_VARIANT
