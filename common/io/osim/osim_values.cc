// SPDX-License-Identifier: MIT
#include "common/io/osim/osim_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/support/text.h"

namespace mmm_converter {
using Eigen::Vector3d;

namespace {

// No body has more in SI units, and squares of it are numbers.
constexpr double kMostOfNumbers = 1e9;

// A MultiplierFunction may hold another one, but none does so often.
constexpr int kDeepest = 16;
// Polynomials of models have up to some 10, and each is evaluated for each marker, frame and
// sample.
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

std::string OsimName(const XmlElement& object) {
  const std::string* name = object.FindAttribute("name");
  return name == nullptr ? "" : std::string(Trim(*name));
}

std::string_view OsimText(const XmlElement& object, std::string_view property) {
  const XmlElement* element = object.FindChild(property);
  return element == nullptr ? std::string_view() : std::string_view(element->text);
}

std::vector<std::string> Words(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n\f\v";
  std::vector<std::string> words;
  for (std::size_t at = text.find_first_not_of(kBlanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(kBlanks, at), text.size());
    words.emplace_back(text.substr(at, end - at));
    at = text.find_first_not_of(kBlanks, end);
  }
  return words;
}

std::vector<double> ReadOsimNumbers(const XmlElement& object, std::string_view property,
                                    std::size_t count, const std::vector<double>& otherwise,
                                    Diagnostics* diagnostics) {
  const XmlElement* element = object.FindChild(property);
  if (element == nullptr || element->text.empty()) return otherwise;
  std::vector<double> numbers;
  const bool are_numbers = AppendDoubles(element->text, &numbers) &&
                           std::all_of(numbers.begin(), numbers.end(),
                                       [](double x) { return std::abs(x) <= kMostOfNumbers; });
  if (are_numbers && (count == 0 || numbers.size() == count)) return numbers;
  diagnostics->AddError(element->line,
                        fmt::format("<{}>: \"{:.60}\" is not {}", element->name, element->text,
                                    count == 0   ? std::string("a list of finite numbers")
                                    : count == 1 ? std::string("a finite number")
                                                 : fmt::format("{} finite numbers", count)));
  return otherwise;
}

double ReadOsimNumber(const XmlElement& object, std::string_view property, double otherwise,
                      Diagnostics* diagnostics) {
  return ReadOsimNumbers(object, property, 1, {otherwise}, diagnostics).front();
}

bool ReadOsimFlag(const XmlElement& object, std::string_view property, bool otherwise,
                  Diagnostics* diagnostics) {
  const XmlElement* element = object.FindChild(property);
  if (element == nullptr || element->text.empty()) return otherwise;
  if (EqualIgnoringCase(element->text, "true") || element->text == "1") return true;
  if (EqualIgnoringCase(element->text, "false") || element->text == "0") return false;
  diagnostics->AddError(element->line, fmt::format("<{}>: \"{:.60}\" is neither true nor false",
                                                   element->name, element->text));
  return otherwise;
}

Vector3d ReadOsimVector(const XmlElement& object, std::string_view property,
                        const Vector3d& otherwise, Diagnostics* diagnostics) {
  const std::vector<double> v = ReadOsimNumbers(
      object, property, 3, {otherwise.x(), otherwise.y(), otherwise.z()}, diagnostics);
  return {v[0], v[1], v[2]};
}

Eigen::Isometry3d ReadOsimPose(const XmlElement& object, std::string_view translation,
                               std::string_view orientation, Diagnostics* diagnostics) {
  const Vector3d turns = ReadOsimVector(object, orientation, Vector3d::Zero(), diagnostics);
  Eigen::Isometry3d X(
      Eigen::Translation3d(ReadOsimVector(object, translation, Vector3d::Zero(), diagnostics)));
  for (int i = 0; i < 3; ++i) X.rotate(Eigen::AngleAxisd(turns[i], Vector3d::Unit(i)));
  return X;
}

const XmlElement* FindOsimObject(const XmlElement& object, std::string_view property) {
  for (const XmlElement& child : object.children) {
    if (child.Is(property)) return child.children.empty() ? nullptr : &child.children.front();
    if (EqualIgnoringCase(OsimName(child), property)) return &child;
  }
  return nullptr;
}

const XmlElement* FindOsimObjects(const XmlElement& owner, std::string_view set) {
  const XmlElement* element = owner.FindChild(set);
  return element == nullptr ? nullptr : element->FindChild("objects");
}

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
