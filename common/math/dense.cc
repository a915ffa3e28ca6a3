// SPDX-License-Identifier: MIT
#include "common/math/dense.h"

#include <cassert>

namespace mmm_converter {
namespace {

const DenseKernels& Active() {
  static const DenseKernels& kernels = DenseKernelsFor(ActiveInstructionSet());
  return kernels;
}

void AddSquare(double alpha, const PaddedMatrix& A, const double* weights, PaddedMatrix* C) {
  assert(C->rows() == A.rows() && C->cols() == A.rows());
  Active().multiply({alpha,
                     A.data(),
                     A.padded_rows(),
                     {A.data(), A.padded_rows(), 1},
                     1,
                     C->data(),
                     C->padded_rows(),
                     A.padded_rows(),
                     A.padded_rows(),
                     A.padded_cols(),
                     Shape::kLowerResult,
                     weights});
}

}  // namespace

const DenseKernels& DenseKernelsFor(InstructionSet set) {
  static constexpr KernelTables<DenseKernels> kTables = MMM_CONVERTER_KERNELS(GetDenseKernels);
  return kTables.For(set);
}

void Multiply(double alpha, const PaddedMatrix& A, const PaddedMatrix& B, PaddedMatrix* C,
              Shape shape) {
  assert(A.cols() <= B.rows() && C->rows() == A.rows() && C->cols() == B.cols());
  Active().multiply({alpha,
                     A.data(),
                     A.padded_rows(),
                     {B.data(), 1, B.padded_rows()},
                     0,
                     C->data(),
                     C->padded_rows(),
                     A.padded_rows(),
                     B.padded_cols(),
                     A.padded_cols(),
                     shape});
}

void MultiplyByTransposed(const PaddedMatrix& A, const PaddedMatrix& B, PaddedMatrix* C,
                          Shape shape) {
  assert(A.cols() == B.cols() && C->rows() == A.rows() && C->cols() == B.rows());
  Active().multiply({1,
                     A.data(),
                     A.padded_rows(),
                     {B.data(), B.padded_rows(), 1},
                     0,
                     C->data(),
                     C->padded_rows(),
                     A.padded_rows(),
                     B.padded_rows(),
                     A.padded_cols(),
                     shape});
}

void AddSquare(double alpha, const PaddedMatrix& A, PaddedMatrix* C) {
  AddSquare(alpha, A, nullptr, C);
}

void AddWeightedSquare(const PaddedMatrix& A, const PaddedMatrix& weights, PaddedMatrix* C) {
  assert(weights.rows() == A.cols());
  AddSquare(1, A, weights.data(), C);
}

void Factorize(PaddedMatrix* A) {
  assert(A->rows() == A->cols());
  Active().factorize(A->data(), A->padded_rows());
}

void DivideByTransposed(const PaddedMatrix& G, PaddedMatrix* X) {
  assert(X->cols() == G.rows());
  Active().divide(G.data(), G.padded_rows(), X->data(), X->padded_rows(), X->padded_rows());
}

void SolveLower(const PaddedMatrix& G, PaddedMatrix* x) {
  assert(x->rows() == G.rows());
  Active().solve(G.data(), G.padded_rows(), x->data());
}

void SolveLowerTransposed(const PaddedMatrix& G, PaddedMatrix* x) {
  assert(x->rows() == G.rows());
  Active().solve_transposed(G.data(), G.padded_rows(), x->data());
}

}  // namespace mmm_converter
