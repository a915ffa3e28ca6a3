// SPDX-License-Identifier: MIT
#include "common/motion/flat_frames.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/math/statistics.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr double kNearLowest = 0.015;  // [m]
constexpr double kSlowUpwards = 0.06;  // [m/s]
constexpr double kLowestPercent = 5;
// Of a foot that stands: markers of ankles go on a little.
constexpr double kStandingSpeed = 0.15;  // [m/s]
constexpr double kStandingTime = 0.1;    // [s]
// A ramp is steeper than floors are and less steep than stairs (DIN 18065: from 20 degrees).
constexpr double kLeastRamp = 2.5 / kDegrees, kMostRamp = 20 / kDegrees;
constexpr double kRampSpread = 0.3;   // [m] standard deviation of the places along the ramp
constexpr double kRampWithin = 0.01;  // [m] of the heights from it: markers and floors are uneven

/// Where a marker stands still, means over each time that it does.
std::vector<Eigen::Vector3d> StandingPlaces(const MarkerSequence& recording, int label) {
  const auto at = [&](int k) -> Eigen::Vector3d { return recording.frame(k).col(label); };
  std::vector<Eigen::Vector3d> places;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (int k = 1; k < recording.num_frames(); ++k) {
    const bool stands = (at(k) - at(k - 1)).norm() * recording.rate() < kStandingSpeed;
    if (stands) {
      sum += at(k);
      ++count;
    }
    if (stands && k + 1 < recording.num_frames()) continue;
    if (count > kStandingTime * recording.rate()) places.emplace_back(sum / count);
    sum.setZero();
    count = 0;
  }
  return places;
}

}  // namespace

Eigen::Vector2d FindRamp(const MarkerSequence& recording, const std::vector<int>& labels) {
  std::vector<Eigen::Vector3d> beside;  // places of each marker from their mean
  for (const int label : labels) {
    const std::vector<Eigen::Vector3d> places = StandingPlaces(recording, label);
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& one : places) mean += one / static_cast<double>(places.size());
    if (places.size() < 2) continue;
    for (const Eigen::Vector3d& one : places) beside.emplace_back(one - mean);
  }
  if (beside.empty()) return Eigen::Vector2d::Zero();
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  Eigen::Vector2d rise = Eigen::Vector2d::Zero();
  for (const Eigen::Vector3d& one : beside) {
    spread += one.head<2>() * one.head<2>().transpose();
    rise += one.z() * one.head<2>();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(spread);
  const Eigen::Vector2d along = axes.eigenvectors().col(1);
  const double squares = axes.eigenvalues()[1];
  const auto count = static_cast<double>(beside.size());
  if (squares < count * kRampSpread * kRampSpread) return Eigen::Vector2d::Zero();
  const double slope = along.dot(rise) / squares;
  double errors = 0;
  for (const Eigen::Vector3d& one : beside) {
    const double error = one.z() - slope * along.dot(one.head<2>());
    errors += error * error;
  }
  const double angle = std::atan(std::abs(slope));
  const bool is_ramp =
      angle > kLeastRamp && angle < kMostRamp && errors < count * kRampWithin * kRampWithin;
  return is_ramp ? Eigen::Vector2d(slope * along) : Eigen::Vector2d::Zero();
}

std::vector<int> FlatFrames(const MarkerSequence& recording, const std::vector<int>& labels,
                            const Eigen::Vector2d& ramp) {
  const int n = recording.num_frames();
  const auto height = [&](int k, std::size_t i) -> double {
    const auto p_W = recording.frame(k).col(labels[i]);
    return p_W.z() - ramp.dot(p_W.head<2>());
  };
  std::vector<double> lowest;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    std::vector<double> heights;
    for (int k = 0; k < n; ++k) {
      if (std::isfinite(height(k, i))) heights.push_back(height(k, i));
    }
    if (heights.empty()) return {};
    lowest.push_back(Percentile(heights, kLowestPercent));
  }
  std::vector<int> flat;
  for (int k = 0; k < n; ++k) {
    const int before = std::max(0, k - 1), after = std::min(n - 1, k + 1);
    const double time = (after - before) / recording.rate();
    bool is_flat = !labels.empty();
    for (std::size_t i = 0; i < labels.size() && is_flat; ++i) {
      const double rise = time > 0 ? (height(after, i) - height(before, i)) / time : 0;
      is_flat = height(k, i) < lowest[i] + kNearLowest && std::abs(rise) < kSlowUpwards;
    }
    if (is_flat) flat.push_back(k);
  }
  return flat;
}

}  // namespace mmm_converter
