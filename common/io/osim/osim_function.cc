// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "common/io/osim/osim_values.h"

namespace mmm_converter {
namespace {

// A MultiplierFunction may hold another one, but none does so often.
constexpr int kDeepest = 16;
// Of a polynomial; those of models have up to some 10, and each is evaluated for each marker, frame
// and sample.
constexpr std::size_t kMostCoefficients = 32;

class FunctionReader {
 public:
  FunctionReader(const std::vector<std::string>& coordinates, Diagnostics* diagnostics)
      : coordinates_(coordinates), diagnostics_(diagnostics) {}

  OsimExpression Read(const XmlElement& function, int depth);

 private:
  OsimExpression ReadLinear(const XmlElement& function);
  OsimExpression ReadPoints(const XmlElement& function, bool is_spline);
  OsimExpression ReadMultiplier(const XmlElement& function, int depth);

  /// The function of the one coordinate that there must be.
  OsimExpression OfOne(const XmlElement& function, ScalarFunction of_one) {
    if (coordinates_.size() != 1) {
      Fail(function,
           fmt::format("is a function of one coordinate, and {} are named", coordinates_.size()));
      return {};
    }
    OsimExpression expression;
    expression.terms.push_back({coordinates_.front(), std::move(of_one)});
    return expression;
  }

  void Fail(const XmlElement& function, const std::string& what) {
    diagnostics_->AddError(function.line, fmt::format("<{}>: {}", function.name, what));
  }

  const std::vector<std::string>& coordinates_;
  Diagnostics* diagnostics_;
};

OsimExpression FunctionReader::ReadLinear(const XmlElement& function) {
  const std::vector<double> c = ReadOsimNumbers(function, "coefficients", 0, {}, diagnostics_);
  if (c.size() != coordinates_.size() + 1) {
    Fail(function, fmt::format("has {} coefficients for {} coordinates; one more than these is "
                               "expected, the constant last",
                               c.size(), coordinates_.size()));
    return {};
  }
  OsimExpression expression;
  expression.constant = c.back();
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    expression.terms.push_back({coordinates_[i], ScalarFunction::Linear(c[i], 0)});
  }
  return expression;
}

OsimExpression FunctionReader::ReadPoints(const XmlElement& function, bool is_spline) {
  const std::vector<double> x = ReadOsimNumbers(function, "x", 0, {}, diagnostics_);
  const std::vector<double> y = ReadOsimNumbers(function, "y", 0, {}, diagnostics_);
  if (x.size() < 2 || y.size() != x.size()) {
    Fail(function, fmt::format("has {} numbers in <x> and {} in <y>; as many are expected, at "
                               "least 2",
                               x.size(), y.size()));
    return {};
  }
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (x[i] >= x[i - 1]) continue;
    Fail(function,
         fmt::format("its <x> must not descend, and {:g} comes after {:g}", x[i], x[i - 1]));
    return {};
  }
  ScalarFunction of_one =
      is_spline ? ScalarFunction::SimmSpline(x, y) : ScalarFunction::PiecewiseLinear(x, y);
  if (!of_one.IsFinite()) {
    Fail(function, "its points are too near to each other, or too large");
    return {};
  }
  return OfOne(function, std::move(of_one));
}

OsimExpression FunctionReader::ReadMultiplier(const XmlElement& function, int depth) {
  const double scale = ReadOsimNumber(function, "scale", 1, diagnostics_);
  const XmlElement* inner = FindOsimObject(function, "function");
  if (inner == nullptr || depth >= kDeepest) {
    Fail(function, inner == nullptr ? "has no function" : "is nested too deeply");
    return {};
  }
  OsimExpression expression = Read(*inner, depth + 1);
  expression.constant *= scale;
  for (OsimExpression::Term& term : expression.terms) term.function = term.function.Scaled(scale);
  return expression;
}

OsimExpression FunctionReader::Read(const XmlElement& function, int depth) {
  if (function.Is("Constant")) {
    OsimExpression expression;
    expression.constant = ReadOsimNumber(function, "value", 0, diagnostics_);
    return expression;
  }
  if (function.Is("LinearFunction")) return ReadLinear(function);
  if (function.Is("MultiplierFunction")) return ReadMultiplier(function, depth);
  if (function.Is("SimmSpline") || function.Is("NaturalCubicSpline") ||
      function.Is("natCubicSpline")) {
    return ReadPoints(function, true);
  }
  if (function.Is("PiecewiseLinearFunction")) return ReadPoints(function, false);
  if (function.Is("PolynomialFunction")) {
    std::vector<double> c = ReadOsimNumbers(function, "coefficients", 0, {}, diagnostics_);
    if (c.empty()) c = {0};
    if (c.size() > kMostCoefficients) {
      Fail(function, fmt::format("has {} coefficients, more than the {} that are read", c.size(),
                                 kMostCoefficients));
      return {};
    }
    return OfOne(function, ScalarFunction::Polynomial(c));
  }
  Fail(function,
       "is not read; Constant, LinearFunction, PolynomialFunction, SimmSpline, "
       "PiecewiseLinearFunction and MultiplierFunction are");
  return {};
}

bool IsPure(const XmlElement& function, const OsimExpression& expression) {
  if (!function.Is("LinearFunction") || expression.terms.size() != 1) return false;
  const auto line = expression.terms.front().function.AsLine();
  return line && std::abs(line->slope) == 1;
}

}  // namespace

OsimExpression ReadOsimFunction(const XmlElement* function,
                                const std::vector<std::string>& coordinates, bool is_identity,
                                bool* is_pure, Diagnostics* diagnostics) {
  if (function == nullptr) {
    OsimExpression expression;
    const bool is_one = is_identity && coordinates.size() == 1;
    if (is_one) expression.terms.push_back({coordinates.front(), ScalarFunction()});
    if (is_pure != nullptr) *is_pure = is_one;
    return expression;
  }
  OsimExpression expression = FunctionReader(coordinates, diagnostics).Read(*function, 0);
  if (is_pure != nullptr) *is_pure = IsPure(*function, expression);
  return expression;
}

}  // namespace mmm_converter
