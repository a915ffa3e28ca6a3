// SPDX-License-Identifier: MIT
#include "plugins/s2kf/lbfgs.h"

#include <algorithm>
#include <deque>
#include <vector>

namespace mmm_converter::s2kf {
namespace {

using Eigen::VectorXd;

struct Correction {
  VectorXd s;  // step
  VectorXd y;  // change of the gradient
  double rho;  // 1 / (s.y)
};

/// -H g, H the inverse Hessian that the corrections, oldest first, imply.
VectorXd Direction(const std::deque<Correction>& corrections, const VectorXd& gradient) {
  VectorXd q = -gradient;
  if (corrections.empty()) return q / std::max(1.0, gradient.norm());
  std::vector<double> alpha(corrections.size());
  for (std::size_t i = corrections.size(); i-- > 0;) {
    alpha[i] = corrections[i].rho * corrections[i].s.dot(q);
    q -= alpha[i] * corrections[i].y;
  }
  q /= corrections.back().rho * corrections.back().y.squaredNorm();
  for (std::size_t i = 0; i < corrections.size(); ++i) {
    const double beta = corrections[i].rho * corrections[i].y.dot(q);
    q += (alpha[i] - beta) * corrections[i].s;
  }
  return q;
}

}  // namespace

VectorXd MinimizeLbfgs(const std::function<double(const VectorXd&, VectorXd&)>& function,
                       VectorXd x, const LbfgsOptions& options) {
  constexpr double kSufficientDecrease = 1e-4;
  constexpr double kSmallestStep = 1e-12;
  std::deque<Correction> corrections;
  VectorXd gradient(x.size());
  VectorXd next_gradient(x.size());
  double value = function(x, gradient);
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    if (gradient.cwiseAbs().maxCoeff() < options.gradient_tolerance) break;
    const VectorXd direction = Direction(corrections, gradient);
    const double slope = direction.dot(gradient);
    double step = 1;
    VectorXd next = x + direction;
    double next_value = function(next, next_gradient);
    while (!(next_value <= value + kSufficientDecrease * step * slope) && step > kSmallestStep) {
      step /= 2;
      next = x + step * direction;
      next_value = function(next, next_gradient);
    }
    if (!(next_value < value)) break;  // rounding
    Correction correction{next - x, next_gradient - gradient, 0};
    const double curvature = correction.s.dot(correction.y);
    if (curvature > 0) {  // keeps H positive definite
      correction.rho = 1 / curvature;
      corrections.push_back(std::move(correction));
      if (corrections.size() > static_cast<std::size_t>(options.memory)) corrections.pop_front();
    }
    x = std::move(next);
    value = next_value;
    gradient.swap(next_gradient);
  }
  return x;
}

}  // namespace mmm_converter::s2kf
