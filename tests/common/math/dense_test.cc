// SPDX-License-Identifier: MIT
#include "common/math/dense.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "common/math/seeded_random.h"

namespace mmm_converter {
namespace {

using Eigen::MatrixXd;

// Sums of up to 160 products of numbers of about 1, well conditioned.
constexpr double kRounding = 1e-12;

PaddedMatrix Random(int rows, int cols, std::uint64_t seed) {
  SeededRandom random(seed);
  PaddedMatrix matrix(rows, cols);
  for (int j = 0; j < cols; ++j) {
    for (int i = 0; i < rows; ++i) matrix.col(j)[i] = random.Normal();
  }
  return matrix;
}

double Distance(const PaddedMatrix& a, const MatrixXd& b) {
  return (a.view() - b).cwiseAbs().maxCoeff();
}

/// The padding is 0: what stands there would be counted by the next product.
void ExpectCleanPadding(const PaddedMatrix& matrix) {
  for (int j = 0; j < matrix.padded_cols(); ++j) {
    for (int i = 0; i < matrix.padded_rows(); ++i) {
      if (i < matrix.rows() && j < matrix.cols()) continue;
      EXPECT_EQ(matrix.col(j)[i], 0) << i << ", " << j;
    }
  }
}

TEST(PaddedMatrixTest, ColumnsAreAlignedAndPaddedWithZeros) {
  PaddedMatrix matrix(13, 5);
  EXPECT_EQ(matrix.padded_rows(), 16);
  EXPECT_EQ(matrix.padded_cols(), 8);
  matrix.view().setConstant(3);
  ExpectCleanPadding(matrix);
  for (int j = 0; j < 5; ++j) EXPECT_EQ(reinterpret_cast<std::uintptr_t>(matrix.col(j)) % 64, 0);
  EXPECT_EQ(PaddedMatrix().data(), nullptr);
}

class DenseTest : public ::testing::TestWithParam<int> {};

TEST_P(DenseTest, ProductsEqualTheirDefinition) {
  const int n = GetParam();
  const PaddedMatrix A = Random(n, 19, 1);
  const PaddedMatrix B = Random(19, 7, 2);
  PaddedMatrix C(n, 7);
  Multiply(0.5, A, B, &C);
  EXPECT_LT(Distance(C, 0.5 * A.view() * B.view()), kRounding);
  ExpectCleanPadding(C);

  const PaddedMatrix tall = Random(40, 7, 3);
  Multiply(2, A, tall, &C);
  EXPECT_LT(Distance(C, 2 * A.view() * tall.view().topRows(19)), kRounding);

  const PaddedMatrix D = Random(11, 19, 4);
  PaddedMatrix E(n, 11);
  MultiplyByTransposed(A, D, &E);
  EXPECT_LT(Distance(E, A.view() * D.view().transpose()), kRounding);
  ExpectCleanPadding(E);

  PaddedMatrix G = Random(19, 19, 5);
  G.view().triangularView<Eigen::StrictlyUpper>().setZero();
  PaddedMatrix F(n, 19);
  MultiplyByTransposed(A, G, &F, Shape::kUpperRight);
  EXPECT_LT(Distance(F, A.view() * G.view().transpose()), kRounding);

  PaddedMatrix U = Random(n, n, 6);
  U.view().triangularView<Eigen::StrictlyLower>().setZero();
  const PaddedMatrix V = Random(n, 7, 7);
  Multiply(1, U, V, &C, Shape::kUpperLeft);
  EXPECT_LT(Distance(C, U.view() * V.view()), kRounding);
}

TEST_P(DenseTest, SquareIsAddedToTheLowerTriangle) {
  const int n = GetParam();
  const PaddedMatrix A = Random(n, 30, 1);
  PaddedMatrix C = Random(n, n, 2);
  const MatrixXd before = C.view();
  AddSquare(-0.25, A, &C);
  const MatrixXd expected = before - 0.25 * A.view() * A.view().transpose();
  const MatrixXd difference = (C.view() - expected).triangularView<Eigen::Lower>();
  EXPECT_LT(difference.cwiseAbs().maxCoeff(), kRounding);
  ExpectCleanPadding(C);

  const PaddedMatrix weights = Random(30, 1, 3);
  C.view() = before;
  AddWeightedSquare(A, weights, &C);
  const MatrixXd W = weights.view().col(0).asDiagonal();
  const MatrixXd weighted =
      (C.view() - before - A.view() * W * A.view().transpose()).triangularView<Eigen::Lower>();
  EXPECT_LT(weighted.cwiseAbs().maxCoeff(), kRounding);
}

TEST_P(DenseTest, FactorAndSolvesInvertTheMatrix) {
  const int n = GetParam();
  const PaddedMatrix A = Random(n, 2 * n, 1);
  PaddedMatrix S(n, n);
  S.view().setIdentity();
  AddSquare(1, A, &S);
  const MatrixXd full = S.view().selfadjointView<Eigen::Lower>();
  PaddedMatrix G = S;
  Factorize(&G);
  EXPECT_LT(Distance(G, MatrixXd(full.llt().matrixL())), kRounding * n);
  ExpectCleanPadding(G);

  PaddedMatrix X = Random(23, n, 2);
  const MatrixXd before = X.view();
  DivideByTransposed(G, &X);
  EXPECT_LT((X.view() * G.view().transpose() - before).cwiseAbs().maxCoeff(), kRounding * n);
  ExpectCleanPadding(X);

  PaddedMatrix x = Random(n, 1, 3);
  const MatrixXd b = x.view();
  SolveLower(G, &x);
  EXPECT_LT((G.view() * x.view() - b).cwiseAbs().maxCoeff(), kRounding * n);
  SolveLowerTransposed(G, &x);
  EXPECT_LT((full * x.view() - b).cwiseAbs().maxCoeff(), kRounding * n * n);
}

INSTANTIATE_TEST_SUITE_P(Sizes, DenseTest, ::testing::Values(1, 5, 8, 16, 23, 46, 112));

TEST(DenseFactorTest, ADirectionWithoutVarianceGetsAColumnOfZeros) {
  // Rank 3 in 10 dimensions, exact in binary.
  PaddedMatrix A(10, 10);
  for (int i = 0; i < 3; ++i) A.view()(i, i) = 4;
  A.view()(9, 0) = 8;
  A.view()(9, 9) = 16;
  const MatrixXd full = A.view().selfadjointView<Eigen::Lower>();
  Factorize(&A);
  EXPECT_EQ(A.view() * A.view().transpose(), full);
  EXPECT_TRUE(A.view().rightCols(7).isZero(0));
}

TEST(DenseVariantsTest, AllInstructionSetsAgreeToRounding) {
  const PaddedMatrix A = Random(46, 150, 1);
  const DenseKernels& baseline = DenseKernelsFor(InstructionSet::kBaseline);
  for (const InstructionSet set : SupportedInstructionSets()) {
    PaddedMatrix factors[2] = {PaddedMatrix(46, 46), PaddedMatrix(46, 46)};
    PaddedMatrix quotients[2] = {Random(30, 46, 2), Random(30, 46, 2)};
    PaddedMatrix solutions[2] = {Random(46, 1, 3), Random(46, 1, 3)};
    for (int i = 0; i < 2; ++i) {
      const DenseKernels& kernels = i == 0 ? baseline : DenseKernelsFor(set);
      double* G = factors[i].data();
      factors[i].view().setIdentity();
      kernels.multiply(
          {1, A.data(), 48, {A.data(), 48, 1}, 1, G, 48, 48, 48, 152, Shape::kLowerResult});
      kernels.factorize(G, 48);
      kernels.divide(G, 48, quotients[i].data(), 32, 32);
      kernels.solve(G, 48, solutions[i].data());
      kernels.solve_transposed(G, 48, solutions[i].data());
    }
    EXPECT_LT(Distance(factors[0], factors[1].view()), kRounding) << ToString(set);
    EXPECT_LT(Distance(quotients[0], quotients[1].view()), kRounding) << ToString(set);
    EXPECT_LT(Distance(solutions[0], solutions[1].view()), kRounding) << ToString(set);
  }
}

}  // namespace
}  // namespace mmm_converter
