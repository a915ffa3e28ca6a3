// SPDX-License-Identifier: MIT
#include "plugins/s2kf/lcd_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "plugins/s2kf/lbfgs.h"
#include "plugins/s2kf/lcd_sampling.h"

namespace mmm_converter::s2kf {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd Normals(int rows, int columns, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(generator); });
}

/// D in one dimension from its definition: the difference of the two localized cumulative
/// distributions, kernels exp(-(x - m)^2 / (2 b^2)), squared and integrated over m and b.
double DistanceByDefinition(const std::vector<double>& samples, double max_width) {
  constexpr int kWidths = 1000;
  constexpr int kPositions = 5000;
  double distance = 0;
  for (int i = 0; i < kWidths; ++i) {
    const double b = max_width * (i + 0.5) / kWidths;
    const double spread = 10 * std::sqrt(1 + b * b);  // beyond, both distributions are below 1e-20
    double integral = 0;
    for (int j = 0; j < kPositions; ++j) {
      const double m = spread * (2 * (j + 0.5) / kPositions - 1);
      double difference = b / std::sqrt(1 + b * b) * std::exp(-m * m / (2 * (1 + b * b)));
      for (const double x : samples) {
        difference -=
            std::exp(-(x - m) * (x - m) / (2 * b * b)) / static_cast<double>(samples.size());
      }
      integral += difference * difference * 2 * spread / kPositions;
    }
    distance += integral / std::sqrt(std::numbers::pi) * max_width / kWidths;
  }
  return distance;
}

TEST(LcdDistanceTest, AgreesWithTheDefinitionInOneDimension) {
  const std::vector<double> samples = {0, 0.6, -0.6, 1.4, -1.4};
  const double expected = DistanceByDefinition(samples, 5);
  const MatrixXd half_samples = (MatrixXd(1, 2) << 0.6, 1.4).finished();
  // Midpoint rule: kernels narrower than the positions' step, 0.004, are not resolved; they weigh
  // b^2 / 2 over the number of samples.
  EXPECT_NEAR(LcdDistance(1).Evaluate(half_samples, nullptr), expected, 2e-6);
}

TEST(LcdDistanceTest, GradientMatchesFiniteDifferences) {
  for (const int dimension : {1, 2, 7, 46}) {
    const LcdDistance distance(dimension);
    const MatrixXd samples = Normals(dimension, 2 * dimension + 1, 1);
    MatrixXd gradient;
    distance.Evaluate(samples, &gradient);
    for (int i = 0; i < samples.size(); i += 1 + dimension) {
      // h^2 times a third derivative of about 0.1, and rounding of D's terms (B^2 1e-16) over h.
      const double h = 1e-3;
      MatrixXd above = samples;
      MatrixXd below = samples;
      above(i) += h;
      below(i) -= h;
      const double slope =
          (distance.Evaluate(above, nullptr) - distance.Evaluate(below, nullptr)) / (2 * h);
      EXPECT_NEAR(gradient(i), slope, 3e-7) << dimension << " dimensions, coordinate " << i;
    }
  }
}

TEST(LcdDistanceTest, CoincidingSamplesAreFinite) {
  MatrixXd gradient;
  const double d = LcdDistance(3).Evaluate(MatrixXd::Zero(3, 4), &gradient);
  EXPECT_TRUE(std::isfinite(d));
  EXPECT_TRUE(gradient.allFinite());
}

TEST(LcdDistanceTest, IsTheSameInEveryRotation) {
  const MatrixXd samples = Normals(8, 20, 2);
  const MatrixXd rotation = RotatedUkfHalfSamples(8, 1) / std::sqrt(8.5);
  const LcdDistance distance(8);
  // Rounding of terms of size B^2/2 = 50.
  EXPECT_NEAR(distance.Evaluate(rotation * samples, nullptr), distance.Evaluate(samples, nullptr),
              1e-12);
}

TEST(LcdDistanceTest, ComputedSamplesAreAMinimum) {
  const MatrixXd best = ComputeLcdHalfSamples(2, 21);
  const LcdDistance distance(2);
  MatrixXd gradient;
  const double d = distance.Evaluate(best, &gradient);
  // Samples are rounded to 1e-6; curvature is below 0.1.
  EXPECT_LT(gradient.cwiseAbs().maxCoeff(), 1e-7);
  for (unsigned seed = 0; seed < 20; ++seed) {
    EXPECT_LT(d, distance.Evaluate(best + 0.01 * Normals(2, 10, seed), nullptr));
  }
}

TEST(LbfgsTest, SolvesRosenbrock) {
  const auto rosenbrock = [](const VectorXd& x, VectorXd& gradient) {
    const double a = 1 - x[0];
    const double b = x[1] - x[0] * x[0];
    gradient[0] = -2 * a - 400 * x[0] * b;
    gradient[1] = 200 * b;
    return a * a + 100 * b * b;
  };
  const VectorXd x = MinimizeLbfgs(rosenbrock, Eigen::Vector2d(-1.2, 1), {});
  // Gradient tolerance 1e-9 over the smallest curvature there, 0.4.
  EXPECT_LT((x - Eigen::Vector2d(1, 1)).norm(), 1e-8);
}

}  // namespace
}  // namespace mmm_converter::s2kf
