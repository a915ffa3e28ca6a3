// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>

namespace mmm_converter::s2kf {

struct LbfgsOptions {
  int memory = 10;  ///< pairs of steps and gradient changes that are kept
  int max_iterations = 2000;
  double gradient_tolerance = 1e-9;  ///< on the largest component
};

/// A local minimum of a smooth function by limited-memory BFGS with a backtracking line search
/// (Nocedal, Wright: Numerical Optimization, 2nd ed., algorithms 7.4 and 7.5). Stops where the
/// gradient is small, rounding hides any further descent, or max_iterations is reached.
/// function(x, gradient) returns its value and writes its gradient.
Eigen::VectorXd MinimizeLbfgs(
    const std::function<double(const Eigen::VectorXd&, Eigen::VectorXd&)>& function,
    Eigen::VectorXd x, const LbfgsOptions& options);

}  // namespace mmm_converter::s2kf
