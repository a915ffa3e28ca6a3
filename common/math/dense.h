// SPDX-License-Identifier: MIT
#pragma once

#include "common/math/dense_kernels.h"
#include "common/math/instruction_set.h"
#include "common/math/padded_matrix.h"

// Linear algebra of one frame: matrices of some 50 to 300 rows, too small for the blocking of large
// libraries. All by the active instruction set; nothing is allocated. Sizes must fit.
namespace mmm_converter {

const DenseKernels& DenseKernelsFor(InstructionSet set);

/// C = alpha A B.
void Multiply(double alpha, const PaddedMatrix& A, const PaddedMatrix& B, PaddedMatrix* C);
/// C = alpha A B where B is the top of a taller matrix.
void MultiplyByTop(double alpha, const PaddedMatrix& A, const PaddedMatrix& B, PaddedMatrix* C);
/// C = A B^T.
void MultiplyByTransposed(const PaddedMatrix& A, const PaddedMatrix& B, PaddedMatrix* C);
/// C = A G^T with a lower triangular G (upper part 0), in half the time.
void MultiplyByTransposedLower(const PaddedMatrix& A, const PaddedMatrix& G, PaddedMatrix* C);
/// C += alpha A A^T, lower triangle only.
void AddSquare(double alpha, const PaddedMatrix& A, PaddedMatrix* C);
/// The lower triangle of A becomes the G of A = G G^T (Cholesky), the rest 0. A direction without
/// variance gets a column of zeros.
void Factorize(PaddedMatrix* A);
/// X = X G^-T with a lower triangular G.
void DivideByTransposed(const PaddedMatrix& G, PaddedMatrix* X);
/// x = G^-1 x and x = G^-T x. x: one column, as long as G is wide.
void SolveLower(const PaddedMatrix& G, PaddedMatrix* x);
void SolveLowerTransposed(const PaddedMatrix& G, PaddedMatrix* x);

}  // namespace mmm_converter
