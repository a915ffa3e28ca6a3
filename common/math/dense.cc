// SPDX-License-Identifier: MIT
#include "common/math/dense.h"

#include <cassert>

namespace mmm_converter {
namespace {

const DenseKernels& Active() {
  static const DenseKernels& kernels = DenseKernelsFor(ActiveInstructionSet());
  return kernels;
}

StridedFactor AsItIs(const PaddedMatrix& B) { return {B.data(), 1, B.padded_rows()}; }
StridedFactor Transposed(const PaddedMatrix& B) { return {B.data(), B.padded_rows(), 1}; }

void Compute(double alpha, const PaddedMatrix& A, const double* W, const StridedFactor& B,
             double beta, Shape shape, PaddedMatrix* C) {
  assert(C->rows() == A.rows());
  DenseProduct product;
  product.alpha = alpha;
  product.A = A.data();
  product.A_col = A.padded_rows();
  product.W = W;
  product.B = B;
  product.beta = beta;
  product.C = C->data();
  product.C_col = C->padded_rows();
  product.rows = C->padded_rows();
  product.cols = C->padded_cols();
  product.depth = A.padded_cols();
  product.shape = shape;
  Active().multiply(product);
}

}  // namespace

const DenseKernels& DenseKernelsFor(InstructionSet set) {
  static constexpr KernelTables<DenseKernels> kTables = MMM_CONVERTER_KERNEL_TABLES(DenseKernels);
  return kTables.For(set);
}

void Multiply(double alpha, const PaddedMatrix& A, const PaddedMatrix& B, PaddedMatrix* C,
              Shape shape) {
  assert(A.cols() <= B.rows() && C->cols() == B.cols());
  Compute(alpha, A, nullptr, AsItIs(B), 0, shape, C);
}

void MultiplyByTransposed(const PaddedMatrix& A, const PaddedMatrix& B, PaddedMatrix* C,
                          Shape shape) {
  assert(A.cols() == B.cols() && C->cols() == B.rows());
  Compute(1, A, nullptr, Transposed(B), 0, shape, C);
}

void AddSquare(double alpha, const PaddedMatrix& A, PaddedMatrix* C) {
  assert(C->cols() == A.rows());
  Compute(alpha, A, nullptr, Transposed(A), 1, Shape::kLowerResult, C);
}

void AddWeightedSquare(const PaddedMatrix& A, const PaddedMatrix& weights, PaddedMatrix* C) {
  assert(C->cols() == A.rows() && weights.rows() == A.cols());
  Compute(1, A, weights.data(), Transposed(A), 1, Shape::kLowerResult, C);
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
