// SPDX-License-Identifier: MIT
#include "common/math/scalar_function.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace mmm_converter {
namespace {

constexpr double kFunctionRounding = 1e-14;  // sums of a few products of order 1

TEST(ScalarFunctionTest, PolynomialsAreWhatTheirCoefficientsSay) {
  const ScalarFunction f = ScalarFunction::Polynomial({2, -1, 0, 3});
  double slope = 0;
  EXPECT_NEAR(f.Value(1.5, &slope), 2 * 3.375 - 2.25 + 3, kFunctionRounding);
  EXPECT_NEAR(slope, 6 * 2.25 - 3, kFunctionRounding);
  EXPECT_EQ(ScalarFunction::Polynomial({0, 4, 5}).AsLine(), (ScalarFunction::Line{4, 5}));
  EXPECT_EQ(ScalarFunction::Polynomial({7}).AsLine(), (ScalarFunction::Line{0, 7}));
  EXPECT_EQ(f.AsLine(), std::nullopt);
}

TEST(ScalarFunctionTest, LinesComposeToLines) {
  const ScalarFunction f = ScalarFunction::Linear(3, 1).After(ScalarFunction::Linear(-2, 5));
  EXPECT_EQ(f.AsLine(), (ScalarFunction::Line{-6, 16}));
  EXPECT_EQ(ScalarFunction().Value(0.25), 0.25);
  EXPECT_EQ(ScalarFunction::Linear(3, 1).Scaled(2).AsLine(), (ScalarFunction::Line{6, 2}));
}

// The third derivative at an end is that of the cubic through the four points there: a cubic is
// met exactly.
TEST(ScalarFunctionTest, SimmSplineMeetsACubicExactly) {
  const auto cubic = [](double x) { return ((0.5 * x - 1) * x + 2) * x - 3; };
  const std::vector<double> x = {-1, -0.4, 0.3, 0.5, 1.2, 2};
  std::vector<double> y;
  for (const double at : x) y.push_back(cubic(at));
  const ScalarFunction spline = ScalarFunction::SimmSpline(x, y);
  for (double at = -1; at <= 2; at += 0.01) {
    double slope = 0;
    EXPECT_NEAR(spline.Value(at, &slope), cubic(at), kFunctionRounding);
    EXPECT_NEAR(slope, (1.5 * at - 2) * at + 2, 1e-13);
  }
}

TEST(ScalarFunctionTest, SimmSplineIsAParabolaThroughThreePointsAndALineThroughTwo) {
  const ScalarFunction three = ScalarFunction::SimmSpline({0, 1, 3}, {0, 1, 9});
  EXPECT_NEAR(three.Value(2), 4, kFunctionRounding);
  const ScalarFunction two = ScalarFunction::SimmSpline({1, 3}, {2, 6});
  EXPECT_EQ(two.AsLine(), (ScalarFunction::Line{2, 0}));
}

TEST(ScalarFunctionTest, SplinesGoOnStraightOutside) {
  const ScalarFunction spline = ScalarFunction::SimmSpline({0, 1, 2, 3}, {0, 1, 0, 2});
  for (const double end : {0.0, 3.0}) {
    double at_end = 0;
    const double value = spline.Value(end, &at_end);
    const double outside = end == 0 ? -0.7 : 3.7;
    double slope = 0;
    EXPECT_NEAR(spline.Value(outside, &slope), value + at_end * (outside - end), kFunctionRounding);
    EXPECT_NEAR(slope, at_end, kFunctionRounding);
  }
}

TEST(ScalarFunctionTest, PiecewiseLinearHasTheSlopeToTheRightAtAPoint) {
  const ScalarFunction f = ScalarFunction::PiecewiseLinear({0, 1, 2}, {0, 1, 4});
  double slope = 0;
  EXPECT_EQ(f.Value(1, &slope), 1);
  EXPECT_EQ(slope, 3);
  EXPECT_EQ(f.Value(3, &slope), 7);
  EXPECT_EQ(slope, 3);
  EXPECT_EQ(f.Value(-2, &slope), -2);
  EXPECT_EQ(slope, 1);
}

TEST(ScalarFunctionTest, ManyValuesAreThoseOfOneEach) {
  const ScalarFunction inner = ScalarFunction::SimmSpline({-1, 0, 1, 2}, {0.5, -0.3, 0.1, 0.9});
  const ScalarFunction f = ScalarFunction::Polynomial({1, 0, 2, 1}).After(inner).Scaled(0.5);
  std::vector<double> x;
  for (int i = 0; i < 100; ++i) x.push_back(3 * std::sin(1.7 * i));
  std::vector<double> y(x.size());
  f.Values(x.data(), static_cast<std::ptrdiff_t>(x.size()), y.data());
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_EQ(y[i], f.Value(x[i]));
    double slope = 0;
    f.Value(x[i], &slope);
    constexpr double kStep = 1e-5;  // of central differences: rounding 1e-11, curvature 1e-9
    EXPECT_NEAR(slope, (f.Value(x[i] + kStep) - f.Value(x[i] - kStep)) / (2 * kStep), 1e-8);
  }
}

}  // namespace
}  // namespace mmm_converter
