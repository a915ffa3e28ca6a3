// SPDX-License-Identifier: MIT
#include "common/io/mesh/extreme_points.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace mmm_converter {
namespace {

// 4 pi / 2000 sr each are 4.5 degrees: of a ball of radius r, r (1 - cos(4.5 / sqrt(2))) are lost
// at most, 0.15 mm of a foot of 100 mm.
constexpr int kDirections = 2000;
constexpr int kBlock = 16;  // directions at once

/// A spiral from pole to pole.
Eigen::Vector3d DirectionOf(int i) {
  const double z = 1 - (2 * i + 1.0) / kDirections;
  const double turn = i * std::numbers::pi * (3 - std::sqrt(5.0));
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

/// Each once.
Eigen::Matrix3Xd Distinct(const Eigen::Matrix3Xd& points) {
  std::vector<Eigen::Vector3d> sorted(points.colwise().begin(), points.colwise().end());
  const auto key = [](const Eigen::Vector3d& p) { return std::tuple(p.x(), p.y(), p.z()); };
  std::sort(sorted.begin(), sorted.end(),
            [&](const auto& a, const auto& b) { return key(a) < key(b); });
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  return Eigen::Map<const Eigen::Matrix3Xd>(sorted.front().data(), 3,
                                            static_cast<Eigen::Index>(sorted.size()));
}

}  // namespace

std::vector<Eigen::Vector3d> ExtremePoints(const Eigen::Matrix3Xd& points) {
  if (points.cols() == 0) return {};
  const Eigen::Matrix3Xd distinct = Distinct(points);
  std::vector<bool> is_extreme(static_cast<std::size_t>(distinct.cols()), false);
  Eigen::Matrix<double, kBlock, 3> directions;
  Eigen::Matrix<double, kBlock, Eigen::Dynamic> along(kBlock, distinct.cols());
  for (int first = 0; first < kDirections; first += kBlock) {
    for (int i = 0; i < kBlock; ++i) directions.row(i) = DirectionOf(first + i).transpose();
    along.noalias() = directions * distinct;
    for (int i = 0; i < kBlock; ++i) {
      Eigen::Index farthest = 0;
      along.row(i).maxCoeff(&farthest);
      is_extreme[static_cast<std::size_t>(farthest)] = true;
    }
  }
  std::vector<Eigen::Vector3d> extreme;
  for (Eigen::Index i = 0; i < distinct.cols(); ++i) {
    if (is_extreme[static_cast<std::size_t>(i)]) extreme.emplace_back(distinct.col(i));
  }
  return extreme;
}

}  // namespace mmm_converter
