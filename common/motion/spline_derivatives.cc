// SPDX-License-Identifier: MIT
#include "common/motion/spline_derivatives.h"

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <array>

#include "common/motion/low_pass.h"

namespace mmm_converter {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr Index kFewestKnots = 6;
constexpr Index kWidth = 5;  // of the splines that do not vanish at a knot

// At a knot, of the five B-splines there (steps of 1): de Boor, "A Practical Guide to Splines".
using Weights = std::array<double, kWidth>;
constexpr Weights kValue = {1.0 / 120, 26.0 / 120, 66.0 / 120, 26.0 / 120, 1.0 / 120};
constexpr Weights kFirst = {-1.0 / 24, -10.0 / 24, 0, 10.0 / 24, 1.0 / 24};
constexpr Weights kSecond = {1.0 / 6, 2.0 / 6, -1, 2.0 / 6, 1.0 / 6};
constexpr Weights kThird = {-0.5, 1, 0, -1, 0.5};
constexpr Weights kFourth = {1, -4, 6, -4, 1};

/// Of knot values: n + 4 coefficients a channel.
MatrixXd Coefficients(const MatrixXd& values) {
  const Index n = values.rows();
  std::vector<Eigen::Triplet<double>> entries;
  const auto add_row = [&entries](Index row, Index knot, const Weights& weights) {
    for (Index i = 0; i < kWidth; ++i) {
      entries.emplace_back(static_cast<int>(row), static_cast<int>(knot + i), weights[i]);
    }
  };
  MatrixXd right = MatrixXd::Zero(n + 4, values.cols());
  add_row(0, 0, kThird);
  add_row(1, 0, kFourth);
  for (Index k = 0; k < n; ++k) add_row(k + 2, k, kValue);
  right.middleRows(2, n) = values;
  add_row(n + 2, n - 1, kFourth);
  add_row(n + 3, n - 1, kThird);
  Eigen::SparseMatrix<double> system(n + 4, n + 4);
  system.setFromTriplets(entries.begin(), entries.end());
  Eigen::SparseLU<Eigen::SparseMatrix<double>> solver(system);
  return solver.solve(right);
}

MatrixXd AtKnots(const MatrixXd& coefficients, const Weights& weights, double scale) {
  const Index n = coefficients.rows() - 4;
  MatrixXd sum = MatrixXd::Zero(n, coefficients.cols());
  for (Index i = 0; i < kWidth; ++i) sum += scale * weights[i] * coefficients.middleRows(i, n);
  return sum;
}

}  // namespace

SplineDerivatives DifferentiateSplines(const MatrixXd& values, double rate) {
  if (values.rows() < kFewestKnots) {
    const MatrixXd zero = MatrixXd::Zero(values.rows(), values.cols());
    return {zero, zero};
  }
  const MatrixXd coefficients = Coefficients(values);
  return {AtKnots(coefficients, kFirst, rate), AtKnots(coefficients, kSecond, rate * rate)};
}

void DifferentiateSplines(PoseTrajectory* trajectory) {
  const int frames = trajectory->num_frames();
  const auto joints = static_cast<Index>(trajectory->joint_names.size());
  const MatrixXd values = ChannelsOf(*trajectory);
  const SplineDerivatives derivatives = DifferentiateSplines(values, trajectory->rate);
  const auto differentiated = [&](const MatrixXd& of) {
    MatrixXd result(6 + joints, frames);
    for (int k = 0; k < frames; ++k) {
      // With |q| = 1: rotation 2 q' q*; of 2 (q'' q* + q' q'*) the last part is real.
      const Eigen::Quaterniond q(Eigen::Vector4d(values.row(k).segment<4>(3).transpose()));
      const Eigen::Quaterniond rate(Eigen::Vector4d(of.row(k).segment<4>(3).transpose()));
      result.col(k) << of.row(k).head<3>().transpose(), 2 * (rate * q.conjugate()).vec(),
          of.row(k).tail(joints).transpose();
    }
    return result;
  };
  trajectory->velocities = differentiated(derivatives.first);
  trajectory->accelerations = differentiated(derivatives.second);
}

}  // namespace mmm_converter
