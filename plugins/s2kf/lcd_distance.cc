// SPDX-License-Identifier: MIT
#include "plugins/s2kf/lcd_distance.h"

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/special_functions/expint.hpp>
#include <cassert>
#include <cmath>
#include <vector>

namespace mmm_converter::s2kf {
namespace {

using Eigen::ArrayXd;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Quadrature = boost::math::quadrature::gauss_kronrod<double, 61>;

double MaxKernelWidth(int dimension) {
  if (dimension == 1) return 5;
  if (dimension <= 10) return 10;
  return dimension <= 100 ? 50 : 100;
}

/// E1(x) = -Ei(-x) for x > 0, in double throughout.
double ExponentialIntegral(double x) {
  using Policy = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
  return boost::math::expint(1, x, Policy());
}

/// Nodes and weights on [0, end]: panels that double in width away from 0, where the integrands are
/// steepest; each is exact to rounding.
void MakeQuadrature(double end, std::vector<double>& nodes, std::vector<double>& weights) {
  double begin = 0;
  for (double panel_end = 0.5; begin < end; panel_end *= 2) {
    const double half_width = (std::min(panel_end, end) - begin) / 2;
    for (std::size_t i = 0; i < Quadrature::abscissa().size(); ++i) {
      const double offset = half_width * Quadrature::abscissa()[i];
      nodes.push_back(begin + half_width + offset);
      weights.push_back(half_width * Quadrature::weights()[i]);
      if (offset == 0) continue;
      nodes.push_back(begin + half_width - offset);
      weights.push_back(half_width * Quadrature::weights()[i]);
    }
    begin += 2 * half_width;
  }
}

/// One term of D3 as a function of the squared distance u of two samples:
/// B^2/2 exp(-u / (4 B^2)) + u/8 Ei(-u / (4 B^2)), and its derivative Ei(-u / (4 B^2)) / 8.
class PairTerm {
 public:
  explicit PairTerm(double max_width) : squared_width_(max_width * max_width) {}

  double operator()(double u, double& derivative) const {
    // Coinciding samples: the derivative is singular, its product with their difference is 0.
    u = std::max(u, 1e-20);
    const double x = u / (4 * squared_width_);
    derivative = -ExponentialIntegral(x) / 8;
    return squared_width_ / 2 * std::exp(-x) + u * derivative;
  }
  double at_zero() const { return squared_width_ / 2; }

 private:
  double squared_width_;
};

/// N^2 D3. slopes: K x K with d(N^2 D3)/ds = half_samples * slopes.
double PairSum(const MatrixXd& half_samples, const PairTerm& term, MatrixXd& slopes) {
  const Eigen::Index num = half_samples.cols();
  const MatrixXd gram = half_samples.transpose() * half_samples;
  slopes.setZero(num, num);
  double sum = (1 + 2 * static_cast<double>(num)) * term.at_zero();  // each sample with itself
  for (Eigen::Index j = 0; j < num; ++j) {
    double to_center = 0;
    double to_mirror = 0;
    sum += 4 * term(gram(j, j), to_center) + 2 * term(4 * gram(j, j), to_mirror);
    slopes(j, j) += 8 * to_center + 16 * to_mirror;
    for (Eigen::Index i = 0; i < j; ++i) {
      double apart = 0;
      double mirrored = 0;
      const double squares = gram(i, i) + gram(j, j);
      sum += 4 * (term(squares - 2 * gram(i, j), apart) + term(squares + 2 * gram(i, j), mirrored));
      slopes(i, j) = slopes(j, i) = 8 * (mirrored - apart);
      slopes(i, i) += 8 * (mirrored + apart);
      slopes(j, j) += 8 * (mirrored + apart);
    }
  }
  return sum;
}

}  // namespace

LcdDistance::LcdDistance(int dimension)
    : dimension_(dimension), max_width_(MaxKernelWidth(dimension)) {
  assert(dimension >= 1 && dimension <= 1000);
  std::vector<double> nodes;
  std::vector<double> weights;
  MakeQuadrature(max_width_, nodes, weights);
  const Eigen::Index size = static_cast<Eigen::Index>(nodes.size());
  const ArrayXd b = ArrayXd::Map(nodes.data(), size);
  const ArrayXd w = ArrayXd::Map(weights.data(), size);
  const ArrayXd b2 = b.square();
  decay_ = 0.5 / (1 + 2 * b2);
  weight_ = w * b * (2 * b2 / (1 + 2 * b2)).pow(dimension / 2.0);
  d1_ = (w * b * (b2 / (1 + b2)).pow(dimension / 2.0)).sum();
}

double LcdDistance::Evaluate(const MatrixXd& half_samples, MatrixXd* gradient) const {
  assert(half_samples.rows() == dimension_);
  const Eigen::Index num = half_samples.cols();
  const double total = 2 * static_cast<double>(num) + 1;  // N

  MatrixXd slopes;
  const double d3 = PairSum(half_samples, PairTerm(max_width_), slopes) / (total * total);
  slopes /= total * total;

  double d2 = weight_.sum() / total;
  for (Eigen::Index i = 0; i < num; ++i) {
    const ArrayXd terms = weight_ * (-half_samples.col(i).squaredNorm() * decay_).exp();
    d2 += 2 * terms.sum() / total;
    slopes(i, i) += 8 * (terms * decay_).sum() / total;  // of -2 D2
  }
  if (gradient != nullptr) *gradient = half_samples * slopes;
  return d1_ - 2 * d2 + d3;
}

}  // namespace mmm_converter::s2kf
