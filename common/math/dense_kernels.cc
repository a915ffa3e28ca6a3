// SPDX-License-Identifier: MIT
#include "common/math/dense_kernels.h"

#include "common/math/lanes.h"

namespace mmm_converter::MMM_CONVERTER_VARIANT {
namespace {

// A tile of C stays in registers: kTileRows vectors by kTileCols columns.
constexpr int kTileRows = 3;
constexpr int kTileCols = kLanes == 8 ? 8 : 4;
constexpr int kBlock = 8;  // columns that are factorised at once; all sizes are multiples of it

template <int kRows>
void MultiplyTile(double alpha, const double* A, std::ptrdiff_t A_col, const StridedFactor& B,
                  double beta, double* C, std::ptrdiff_t C_col, int depth) {
  Lanes sum[kTileCols][kRows] = {};
  const double* b = B.data;
  for (int k = 0; k < depth; ++k) {
    Lanes a[kRows];
    for (int r = 0; r < kRows; ++r) a[r] = LoadLanes(A + r * kLanes);
    for (int c = 0; c < kTileCols; ++c) {
      const double factor = b[c * B.col];
      for (int r = 0; r < kRows; ++r) sum[c][r] += a[r] * factor;
    }
    A += A_col;
    b += B.row;
  }
  for (int c = 0; c < kTileCols; ++c) {
    double* target = C + c * C_col;
    for (int r = 0; r < kRows; ++r) {
      Lanes result = alpha * sum[c][r];
      if (beta != 0) result += beta * LoadLanes(target + r * kLanes);
      StoreLanes(result, target + r * kLanes);
    }
  }
}

void Multiply(double alpha, const double* A, std::ptrdiff_t A_col, const StridedFactor& B,
              double beta, double* C, std::ptrdiff_t C_col, int rows, int cols, int depth,
              Shape shape) {
  for (int j = 0; j < cols; j += kTileCols) {
    const StridedFactor B_j = {B.data + j * B.col, B.row, B.col};
    const int least = shape == Shape::kUpperFactor ? j + kTileCols : depth;
    const int depth_j = least < depth ? least : depth;
    int i = shape == Shape::kLowerResult ? j / kLanes * kLanes : 0;
    double* C_j = C + j * C_col;
    for (; i + kTileRows * kLanes <= rows; i += kTileRows * kLanes) {
      MultiplyTile<kTileRows>(alpha, A + i, A_col, B_j, beta, C_j + i, C_col, depth_j);
    }
    for (; i < rows; i += kLanes) {
      MultiplyTile<1>(alpha, A + i, A_col, B_j, beta, C_j + i, C_col, depth_j);
    }
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
    Multiply(-1, A + j, stride, left, 1, diagonal, stride, size - j, kBlock, j, Shape::kFull);
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
    Multiply(-1, X, X_col, left, 1, X_j, X_col, rows, kBlock, j, Shape::kFull);
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
