// SPDX-License-Identifier: MIT
#include "common/motion/low_pass.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <vector>

namespace mmm_converter {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr std::array<double, 4> kThirdDifference = {-1, 3, -3, 1};

/// The weight of the third differences with which the cut-off passes 1/sqrt(2): a frequency f is
/// multiplied by 1 / (1 + lambda (2 sin(pi f / rate))^6).
double Weight(double rate, double cutoff) {
  const double difference = 2 * std::sin(std::numbers::pi * cutoff / rate);
  return (std::numbers::sqrt2 - 1) / std::pow(difference, 6);
}

/// D y, third differences.
MatrixXd Differences(const MatrixXd& y) {
  const Index n = y.rows() - 3;
  return y.bottomRows(n) - y.topRows(n) + 3 * (y.middleRows(1, n) - y.middleRows(2, n));
}

/// D^T d.
MatrixXd TransposedDifferences(const MatrixXd& d) {
  MatrixXd y = MatrixXd::Zero(d.rows() + 3, d.cols());
  for (Index i = 0; i < 4; ++i) y.middleRows(i, d.rows()) += kThirdDifference[i] * d;
  return y;
}

/// I + lambda D^T D = L L^T of band 3; row i holds L(i, i - 3) ... L(i, i).
std::vector<std::array<double, 4>> BandedCholesky(Index n, double lambda) {
  std::vector<std::array<double, 4>> L(n, {0, 0, 0, 1});
  for (Index row = 0; row + 3 < n; ++row) {
    for (Index i = 0; i < 4; ++i) {
      for (Index j = 0; j <= i; ++j) {
        L[row + i][3 - (i - j)] += lambda * kThirdDifference[i] * kThirdDifference[j];
      }
    }
  }
  for (Index i = 0; i < n; ++i) {
    for (Index j = std::max<Index>(0, i - 3); j <= i; ++j) {
      double& value = L[i][3 - (i - j)];
      for (Index k = std::max<Index>(0, i - 3); k < j; ++k) {
        value -= L[i][3 - (i - k)] * L[j][3 - (j - k)];
      }
      value = j < i ? value / L[j][3] : std::sqrt(value);
    }
  }
  return L;
}

/// Solves L L^T x = b in place.
void Solve(const std::vector<std::array<double, 4>>& L, MatrixXd* b) {
  const auto n = static_cast<Index>(L.size());
  for (Index i = 0; i < n; ++i) {
    for (Index k = std::max<Index>(0, i - 3); k < i; ++k) {
      b->row(i) -= L[i][3 - (i - k)] * b->row(k);
    }
    b->row(i) /= L[i][3];
  }
  for (Index i = n - 1; i >= 0; --i) {
    for (Index k = i + 1; k <= std::min(n - 1, i + 3); ++k) {
      b->row(i) -= L[k][3 - (k - i)] * b->row(k);
    }
    b->row(i) /= L[i][3];
  }
}

}  // namespace

MatrixXd LowPassed(const MatrixXd& values, double rate, double cutoff) {
  assert(cutoff > 0 && cutoff <= LargestCutoff(rate));
  if (values.rows() < 4) return values;
  // What is taken away, as lambda may be large: rounding is relative to the noise, not to the
  // signal.
  const double lambda = Weight(rate, cutoff);
  MatrixXd removed = lambda * TransposedDifferences(Differences(values));
  Solve(BandedCholesky(values.rows(), lambda), &removed);
  return values - removed;
}

MatrixXd ChannelsOf(const PoseTrajectory& motion) {
  const auto joints = static_cast<Index>(motion.joint_names.size());
  MatrixXd values(motion.num_frames(), 7 + joints);
  Eigen::Vector4d previous = Eigen::Vector4d::Zero();
  for (int k = 0; k < motion.num_frames(); ++k) {
    const Posture& q = motion.postures[k];
    Eigen::Vector4d orientation = q.orientation.coeffs();
    if (orientation.dot(previous) < 0) orientation = -orientation;
    values.row(k) << q.position.transpose(), orientation.transpose(), q.joint_angles.transpose();
    previous = orientation;
  }
  return values;
}

PoseTrajectory LowPassed(const PoseTrajectory& motion, double cutoff) {
  const auto joints = static_cast<Index>(motion.joint_names.size());
  const MatrixXd values = LowPassed(ChannelsOf(motion), motion.rate, cutoff);

  PoseTrajectory smooth;
  smooth.rate = motion.rate;
  smooth.first_time = motion.first_time;
  smooth.joint_names = motion.joint_names;
  smooth.postures.resize(motion.postures.size());
  for (int k = 0; k < motion.num_frames(); ++k) {
    const Eigen::VectorXd row = values.row(k).transpose();
    smooth.postures[k].position = row.head<3>();
    smooth.postures[k].orientation = Eigen::Quaterniond(row.segment<4>(3).normalized());
    smooth.postures[k].joint_angles = row.tail(joints);
  }
  return smooth;
}

}  // namespace mmm_converter
