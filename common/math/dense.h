// SPDX-License-Identifier: MIT
#pragma once

#include "common/math/dense_kernels.h"
#include "common/math/instruction_set.h"
#include "common/math/padded_matrix.h"

// Linear algebra of one frame: matrices of some 50 to 300 rows, too small for the blocking of large
// libraries. All by the active instruction set; nothing is allocated. Sizes must fit.
namespace mmm_converter {

const DenseKernels& DenseKernelsFor(InstructionSet set);

/// C = alpha A B; of B only as many rows as A has columns. shape: kFull or kUpperLeft.
void Multiply(double alpha, const PaddedMatrix& A, const PaddedMatrix& B, PaddedMatrix* C,
              Shape shape = Shape::kFull);
/// C = A B^T. shape: kFull, or kUpperRight where B is lower triangular.
void MultiplyByTransposed(const PaddedMatrix& A, const PaddedMatrix& B, PaddedMatrix* C,
                          Shape shape = Shape::kFull);
/// C += alpha A A^T, lower triangle only.
void AddSquare(double alpha, const PaddedMatrix& A, PaddedMatrix* C);
/// C += A diag(weights) A^T, lower triangle only. weights: one column.
void AddWeightedSquare(const PaddedMatrix& A, const PaddedMatrix& weights, PaddedMatrix* C);
/// The lower triangle of A becomes the G of A = G G^T (Cholesky), the rest 0. A direction without
/// variance gets a column of zeros.
void Factorize(PaddedMatrix* A);
/// X = X G^-T with a lower triangular G.
void DivideByTransposed(const PaddedMatrix& G, PaddedMatrix* X);
/// x = G^-1 x and x = G^-T x. x: one column, as long as G is wide.
void SolveLower(const PaddedMatrix& G, PaddedMatrix* x);
void SolveLowerTransposed(const PaddedMatrix& G, PaddedMatrix* x);

}  // namespace mmm_converter
