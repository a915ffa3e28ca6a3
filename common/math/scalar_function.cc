// SPDX-License-Identifier: MIT
#include "common/math/scalar_function.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace mmm_converter {
namespace {

// Points nearer than this to each other count as so far apart (SIMM).
constexpr double kLeastStep = 1e-7;

std::vector<double> Steps(const std::vector<double>& x) {
  std::vector<double> steps(x.size() - 1);
  for (std::size_t i = 0; i + 1 < x.size(); ++i) steps[i] = std::max(kLeastStep, x[i + 1] - x[i]);
  return steps;
}

/// f''/6 at the points of the spline, n >= 3: h their steps, slopes those of the chords.
std::vector<double> Curvatures(const std::vector<double>& x, const std::vector<double>& h,
                               const std::vector<double>& slopes) {
  const std::size_t n = x.size();
  std::vector<double> diagonal(n), s(n, 0);
  diagonal[0] = -h[0];
  diagonal[n - 1] = -h[n - 2];
  for (std::size_t i = 1; i + 1 < n; ++i) {
    diagonal[i] = 2 * (h[i - 1] + h[i]);
    s[i] = slopes[i] - slopes[i - 1];
  }
  if (n > 3) {
    const auto span = [&x](std::size_t a, std::size_t b) {
      return std::max(kLeastStep, x[b] - x[a]);
    };
    s[0] = h[0] * h[0] / span(0, 3) * (s[2] / span(1, 3) - s[1] / span(0, 2));
    s[n - 1] = -h[n - 2] * h[n - 2] / span(n - 4, n - 1) *
               (s[n - 2] / span(n - 3, n - 1) - s[n - 3] / span(n - 4, n - 2));
  }
  for (std::size_t i = 1; i < n; ++i) {
    const double factor = h[i - 1] / diagonal[i - 1];
    diagonal[i] -= factor * h[i - 1];
    s[i] -= factor * s[i - 1];
  }
  s[n - 1] /= diagonal[n - 1];
  for (std::size_t i = n - 1; i-- > 0;) s[i] = (s[i] - h[i] * s[i + 1]) / diagonal[i];
  return s;
}

}  // namespace

/// A piece between each two points and one at both ends, coefficients 0.
ScalarFunction::Stage ScalarFunction::WithStraightEnds(const std::vector<double>& x,
                                                       std::size_t order) {
  Stage stage;
  stage.breaks = x;
  stage.origins = x;
  stage.origins.insert(stage.origins.begin(), x.front());
  stage.order = order;
  stage.coefficients.assign(order * (x.size() + 1), 0);
  return stage;
}

ScalarFunction ScalarFunction::Linear(double slope, double offset) {
  if (slope == 1 && offset == 0) return {};
  return ScalarFunction(Stage{{}, {0}, {offset, slope}, 2});
}

ScalarFunction ScalarFunction::Polynomial(const std::vector<double>& coefficients) {
  assert(!coefficients.empty());
  Stage stage{{}, {0}, {coefficients.rbegin(), coefficients.rend()}, coefficients.size()};
  while (stage.order > 2 && stage.coefficients.back() == 0) {
    stage.coefficients.pop_back();
    --stage.order;
  }
  if (stage.order == 1) stage.coefficients.push_back(0);
  stage.order = stage.coefficients.size();
  if (stage.order == 2) return Linear(stage.coefficients[1], stage.coefficients[0]);
  return ScalarFunction(std::move(stage));
}

ScalarFunction ScalarFunction::PiecewiseLinear(const std::vector<double>& x,
                                               const std::vector<double>& y) {
  assert(x.size() == y.size() && x.size() >= 2);
  const std::vector<double> h = Steps(x);
  Stage stage = WithStraightEnds(x, 2);
  for (std::size_t piece = 0; piece <= x.size(); ++piece) {
    const std::size_t from = std::min(piece == 0 ? 0 : piece - 1, x.size() - 2);
    stage.coefficients[2 * piece] = y[piece == 0 ? 0 : piece - 1];
    stage.coefficients[2 * piece + 1] = (y[from + 1] - y[from]) / h[from];
  }
  return ScalarFunction(std::move(stage));
}

ScalarFunction ScalarFunction::SimmSpline(const std::vector<double>& x,
                                          const std::vector<double>& y) {
  assert(x.size() == y.size() && x.size() >= 2);
  const std::size_t n = x.size();
  const std::vector<double> h = Steps(x);
  if (n == 2) {
    const double slope = (y[1] - y[0]) / h[0];
    return Linear(slope, y[0] - slope * x[0]);
  }
  std::vector<double> slopes(n - 1);
  for (std::size_t i = 0; i + 1 < n; ++i) slopes[i] = (y[i + 1] - y[i]) / h[i];
  const std::vector<double> s = Curvatures(x, h, slopes);
  Stage stage = WithStraightEnds(x, 4);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    double* c = &stage.coefficients[4 * (i + 1)];
    c[0] = y[i];
    c[1] = slopes[i] - h[i] * (s[i + 1] + 2 * s[i]);
    c[2] = 3 * s[i];
    c[3] = (s[i + 1] - s[i]) / h[i];
  }
  stage.coefficients[0] = y[0];
  stage.coefficients[1] = stage.coefficients[5];
  stage.coefficients[4 * n] = y[n - 1];
  stage.coefficients[4 * n + 1] = slopes[n - 2] + h[n - 2] * (s[n - 2] + 2 * s[n - 1]);
  return ScalarFunction(std::move(stage));
}

ScalarFunction ScalarFunction::Scaled(double factor) const {
  return Linear(factor, 0).After(*this);
}

ScalarFunction ScalarFunction::After(const ScalarFunction& inner) const {
  const std::optional<Line> outer_line = AsLine();
  const std::optional<Line> inner_line = inner.AsLine();
  if (outer_line && inner_line) {
    return Linear(outer_line->slope * inner_line->slope,
                  outer_line->slope * inner_line->offset + outer_line->offset);
  }
  ScalarFunction both = inner;
  if (outer_line && !both.stages_.empty()) {
    Stage& last = both.stages_.back();
    for (double& c : last.coefficients) c *= outer_line->slope;
    for (std::size_t i = 0; i < last.coefficients.size(); i += last.order) {
      last.coefficients[i] += outer_line->offset;
    }
    return both;
  }
  both.stages_.insert(both.stages_.end(), stages_.begin(), stages_.end());
  return both;
}

std::size_t ScalarFunction::PieceOf(const Stage& stage, double x) {
  return static_cast<std::size_t>(std::upper_bound(stage.breaks.begin(), stage.breaks.end(), x) -
                                  stage.breaks.begin());
}

double ScalarFunction::Value(double x, double* slope, double* curvature) const {
  double total = 1;
  double bend = 0;
  for (const Stage& stage : stages_) {
    const std::size_t piece = PieceOf(stage, x);
    const double* c = &stage.coefficients[piece * stage.order];
    const double t = x - stage.origins[piece];
    double value = 0;
    double derivative = 0;
    double second = 0;
    for (std::size_t i = stage.order; i-- > 0;) {
      second = second * t + 2 * derivative;
      derivative = derivative * t + value;
      value = value * t + c[i];
    }
    bend = second * total * total + derivative * bend;
    total *= derivative;
    x = value;
  }
  if (slope != nullptr) *slope = total;
  if (curvature != nullptr) *curvature = bend;
  return x;
}

void ScalarFunction::Values(const double* x, std::ptrdiff_t count, double* y) const {
  if (y != x) std::copy(x, x + count, y);
  for (const Stage& stage : stages_) {
    const std::size_t last = stage.breaks.size();
    std::size_t piece = 0;
    for (std::ptrdiff_t i = 0; i < count; ++i) {
      const bool is_here = (piece == 0 || y[i] >= stage.breaks[piece - 1]) &&
                           (piece == last || y[i] < stage.breaks[piece]);
      if (!is_here) piece = PieceOf(stage, y[i]);
      const double* c = &stage.coefficients[piece * stage.order];
      const double t = y[i] - stage.origins[piece];
      double value = 0;
      for (std::size_t k = stage.order; k-- > 0;) value = value * t + c[k];
      y[i] = value;
    }
  }
}

std::optional<ScalarFunction::Line> ScalarFunction::AsLine() const {
  if (stages_.empty()) return Line{};
  const Stage& only = stages_.front();
  if (stages_.size() > 1 || only.order > 2 || !only.breaks.empty()) return std::nullopt;
  return Line{only.coefficients[1], only.coefficients[0]};
}

std::size_t ScalarFunction::size() const {
  std::size_t size = 0;
  for (const Stage& stage : stages_) size += 2 * stage.breaks.size() + stage.coefficients.size();
  return size;
}

bool ScalarFunction::IsFinite() const {
  const auto finite = [](double value) { return std::isfinite(value); };
  return std::all_of(stages_.begin(), stages_.end(), [&](const Stage& stage) {
    return std::all_of(stage.breaks.begin(), stage.breaks.end(), finite) &&
           std::all_of(stage.coefficients.begin(), stage.coefficients.end(), finite);
  });
}

}  // namespace mmm_converter
