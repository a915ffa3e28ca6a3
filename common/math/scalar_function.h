// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace mmm_converter {

/// A function of one number that is polynomial piece by piece, or several of them one after the
/// other: what joints of musculoskeletal models move by. Immutable; the default is the identity.
class ScalarFunction {
 public:
  struct Line {
    double slope = 1;
    double offset = 0;
    bool operator==(const Line& other) const {
      return slope == other.slope && offset == other.offset;
    }
  };

  ScalarFunction() = default;

  /// One of the functions, applied to the value of the one before. Its piece i is to the left of
  /// breaks[i], or the last.
  struct Stage {
    std::vector<double> breaks;        ///< between the pieces, ascending
    std::vector<double> origins;       ///< by piece
    std::vector<double> coefficients;  ///< by piece, of powers of x - origin, lowest first
    std::size_t order = 2;             ///< coefficients of a piece
  };

  static ScalarFunction Linear(double slope, double offset);
  /// coefficients: highest power first, at least one.
  static ScalarFunction Polynomial(const std::vector<double>& coefficients);
  /// Straight between the points and, with the slopes of the ends, outside. At a point the slope is
  /// that to its right. x: ascending; at least two points.
  static ScalarFunction PiecewiseLinear(const std::vector<double>& x, const std::vector<double>& y);
  /// SIMM's and OpenSim's interpolating cubic spline (SimmSpline, NaturalCubicSpline): the third
  /// derivative at an end is that of the cubic through the four points there (Forsythe, Malcolm,
  /// Moler 1977). Straight outside. x: ascending; at least two points.
  static ScalarFunction SimmSpline(const std::vector<double>& x, const std::vector<double>& y);

  ScalarFunction Scaled(double factor) const;
  /// x -> this(inner(x))
  ScalarFunction After(const ScalarFunction& inner) const;

  /// slope, curvature: the first and the second derivative there; may be null.
  double Value(double x, double* slope = nullptr, double* curvature = nullptr) const;
  /// y[i] = Value(x[i]), faster where neighbours are of one piece. y may be x.
  void Values(const double* x, std::ptrdiff_t count, double* y) const;

  const std::vector<Stage>& stages() const { return stages_; }  ///< none: the identity
  std::optional<Line> AsLine() const;                           ///< nothing: it is not straight
  bool IsFinite() const;                                        ///< all of its numbers
  std::size_t size() const;                                     ///< how many these are

 private:
  explicit ScalarFunction(Stage stage) : stages_{std::move(stage)} {}

  static std::size_t PieceOf(const Stage& stage, double x);
  static Stage WithStraightEnds(const std::vector<double>& x, std::size_t order);

  std::vector<Stage> stages_;  // none: the identity
};

}  // namespace mmm_converter
