// SPDX-License-Identifier: MIT
#include "common/dynamics/ballistic_phases.h"

#include <Eigen/QR>
#include <cmath>

#include "common/motion/ground_rules.h"

namespace mmm_converter {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

/// Sets acceleration and parabola_rms. Time runs from -1 to 1 for the numbers' sake.
void FitParabola(const Eigen::Matrix3Xd& com, double rate, BallisticPhase* phase) {
  const Index n = com.cols();
  const Eigen::ArrayXd s = Eigen::ArrayXd::LinSpaced(n, -1, 1);
  Eigen::MatrixX3d basis(n, 3);
  basis << Eigen::VectorXd::Ones(n), s, s.square();
  const Eigen::Matrix3d coefficients = basis.householderQr().solve(com.transpose());
  const double half_duration = 0.5 * static_cast<double>(n - 1) / rate;
  phase->acceleration = 2 * coefficients.row(2).transpose() / (half_duration * half_duration);
  const Eigen::MatrixXd residuals = com.transpose() - basis.lazyProduct(coefficients);
  phase->parabola_rms = std::sqrt(residuals.squaredNorm() / static_cast<double>(n));
}

BallisticPhase Describe(const MotionDynamics& dynamics, const Eigen::Matrix3Xd& measured_com,
                        int begin, int end) {
  const int n = end - begin;
  BallisticPhase phase;
  phase.begin = begin;
  phase.end = end;
  FitParabola(measured_com.middleCols(begin, n), dynamics.rate, &phase);
  phase.mean_acceleration = dynamics.com_acceleration.middleCols(begin, n).rowwise().mean();
  phase.mean_force =
      dynamics.residual_force.middleCols(begin, n).colwise().norm().mean() / dynamics.body_weight();
  const Eigen::Matrix3Xd L = dynamics.angular_momentum.middleCols(begin, n);
  phase.angular_momentum = L.rowwise().mean();
  const Eigen::RowVectorXd deviations = (L.colwise() - phase.angular_momentum).colwise().norm();
  phase.angular_momentum_rms = std::sqrt(deviations.squaredNorm() / n);
  phase.angular_momentum_max = deviations.maxCoeff();
  phase.segment_angular_momentum = dynamics.segment_angular_momentum.segment(begin, n).mean();
  return phase;
}

}  // namespace

std::vector<BallisticPhase> FindBallisticPhases(const MotionDynamics& dynamics,
                                                const Eigen::Matrix3Xd& measured_com,
                                                double shortest) {
  std::vector<BallisticPhase> phases;
  const int frames = dynamics.num_frames();
  // A parabola needs three frames, and one more to be a test.
  const int least = std::max(4, static_cast<int>(std::ceil(shortest * dynamics.rate)));
  int begin = 0;
  for (int k = 0; k <= frames; ++k) {
    if (k < frames && dynamics.contact_heights.col(k).minCoeff() > kRestHeight) continue;
    if (k - begin >= least) phases.push_back(Describe(dynamics, measured_com, begin, k));
    begin = k + 1;
  }
  return phases;
}

}  // namespace mmm_converter
