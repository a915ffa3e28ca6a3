// SPDX-License-Identifier: MIT
#include "common/label/search/rigid_finder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/fit/rigid_shape.h"
#include "common/label/tuning.h"
#include "common/support/units.h"

namespace mmm_converter {

using Eigen::Matrix3Xd;
using Eigen::Ref;

namespace {

// A search is given up after so many looks at a point; to try three points counts as some.

}  // namespace

RigidFinder::RigidFinder(Matrix3Xd p_OM)
    : p_OM_(std::move(p_OM)), z_(3, p_OM_.cols()), weights_(Eigen::VectorXd::Ones(p_OM_.cols())) {
  const auto side = [this](int a, int b) { return (p_OM_.col(a) - p_OM_.col(b)).norm(); };
  for (int a = 0; a < num_markers(); ++a) {
    for (int b = a + 1; b < num_markers(); ++b) {
      for (int c = b + 1; c < num_markers(); ++c) {
        triples_.push_back({std::min({side(a, b), side(a, c), side(b, c)}), {a, b, c}});
      }
    }
  }
  std::stable_sort(triples_.begin(), triples_.end(), [](const Triple& a, const Triple& b) {
    return a.shortest_side > b.shortest_side;
  });
  triples_.resize(std::min(triples_.size(), ObjectTuning::kMostTriples));
}

int RigidFinder::CountFound() const {
  return static_cast<int>(std::count_if(point_of_marker_.begin(), point_of_marker_.end(),
                                        [](int point) { return point >= 0; }));
}

double RigidFinder::SquaredResidual(const Ref<const Matrix3Xd>& points) const {
  double sum = 0;
  for (int m = 0; m < num_markers(); ++m) {
    if (point_of_marker_[m] < 0) continue;
    sum += (X_WO_ * p_OM_.col(m) - points.col(point_of_marker_[m])).squaredNorm();
  }
  return sum;
}

bool RigidFinder::Fit(const Ref<const Matrix3Xd>& points) {
  while (CountFound() >= ObjectTuning::kFewest) {
    z_.setConstant(kNaN);
    for (int m = 0; m < num_markers(); ++m) {
      if (point_of_marker_[m] >= 0) z_.col(m) = points.col(point_of_marker_[m]);
    }
    if (DistanceFromLine(z_) < ObjectTuning::kOffLine) return false;
    X_WO_ = FitRigidPose(p_OM_, z_, weights_);
    int worst = -1;
    double farthest = ObjectTuning::kInPlace;
    for (int m = 0; m < num_markers(); ++m) {
      if (point_of_marker_[m] < 0) continue;
      const double distance = (X_WO_ * p_OM_.col(m) - z_.col(m)).norm();
      if (distance <= farthest) continue;
      farthest = distance;
      worst = m;
    }
    if (worst < 0) return true;
    point_of_marker_[worst] = -1;
  }
  return false;
}

void RigidFinder::Complete(const Ref<const Matrix3Xd>& points, double reach) {
  for (int m = 0; m < num_markers(); ++m) {
    if (point_of_marker_[m] >= 0) continue;
    double nearest = reach * reach;
    for (int p = 0; p < points.cols(); ++p) {
      const double distance = (X_WO_ * p_OM_.col(m) - points.col(p)).squaredNorm();
      if (distance >= nearest || std::count(point_of_marker_.begin(), point_of_marker_.end(), p)) {
        continue;
      }
      nearest = distance;
      point_of_marker_[m] = p;
    }
  }
}

bool RigidFinder::Settle(const Ref<const Matrix3Xd>& points) {
  if (!Fit(points)) return false;
  Complete(points, ObjectTuning::kInPlace);
  return Fit(points);
}

bool RigidFinder::SettleWithoutOne(const Ref<const Matrix3Xd>& points) {
  const std::vector<int> first = point_of_marker_;
  Eigen::Isometry3d best_X_WO = X_WO_;
  int most = 0;
  double least = 0;
  for (int left_out = -1; left_out < num_markers(); ++left_out) {
    if (left_out >= 0 && first[left_out] < 0) continue;
    point_of_marker_ = first;
    if (left_out >= 0) point_of_marker_[left_out] = -1;
    if (!Settle(points)) continue;
    const int found = CountFound();
    const double residual = SquaredResidual(points);
    if (found < most || (found == most && residual >= least)) continue;
    most = found;
    least = residual;
    best_ = point_of_marker_;
    best_X_WO = X_WO_;
  }
  if (most == 0) return false;
  point_of_marker_ = best_;
  X_WO_ = best_X_WO;
  return true;
}

const std::vector<int>& RigidFinder::Find(const Ref<const Matrix3Xd>& points) {
  const int fewest = std::min(num_markers(), ObjectTuning::kFewestAnywhere);
  best_.assign(static_cast<std::size_t>(num_markers()), -1);
  frames_ = 0;
  if (points.cols() < fewest || points.cols() > ObjectTuning::kMostPoints) return best_;
  const auto count = static_cast<int>(points.cols());
  pairs_.clear();
  for (int i = 0; i < count; ++i) {
    for (int j = i + 1; j < count; ++j) {
      pairs_.push_back({(points.col(i) - points.col(j)).norm(), i, j});
    }
  }
  const auto is_shorter = [](const Pair& a, const Pair& b) { return a.distance < b.distance; };
  std::sort(pairs_.begin(), pairs_.end(), is_shorter);
  Eigen::Isometry3d best_X_WO = Eigen::Isometry3d::Identity();
  int most = fewest - 1;
  double least = 0;
  // Three markers a, b, c and three points i, j, k at the same distances from each other.
  const auto try_three = [&](const std::array<int, 3>& markers, const std::array<int, 3>& three) {
    point_of_marker_.assign(static_cast<std::size_t>(num_markers()), -1);
    for (std::size_t i = 0; i < 3; ++i) point_of_marker_[markers[i]] = three[i];
    if (!Settle(points)) return;
    const int found = CountFound();
    const double residual = SquaredResidual(points);
    if (found < most || (found == most && (most < fewest || residual >= least))) return;
    most = found;
    least = residual;
    best_ = point_of_marker_;
    best_X_WO = X_WO_;
    frames_ = 1;
  };
  long checks = ObjectTuning::kMostChecks;
  for (const Triple& triple : triples_) {
    const auto& [a, b, c] = triple.markers;
    const double ab = (p_OM_.col(a) - p_OM_.col(b)).norm();
    const double ac = (p_OM_.col(a) - p_OM_.col(c)).norm();
    const double bc = (p_OM_.col(b) - p_OM_.col(c)).norm();
    const auto from = std::lower_bound(pairs_.begin(), pairs_.end(),
                                       Pair{ab - ObjectTuning::kInPlace, 0, 0}, is_shorter);
    const auto to =
        std::upper_bound(from, pairs_.end(), Pair{ab + ObjectTuning::kInPlace, 0, 0}, is_shorter);
    for (auto pair = from; pair != to && checks > 0; ++pair) {
      checks -= 2 * count;
      for (const auto& [i, j] :
           {std::pair(pair->first, pair->second), std::pair(pair->second, pair->first)}) {
        for (int k = 0; k < count && checks > 0; ++k) {
          if (k == i || k == j) continue;
          if (std::abs((points.col(k) - points.col(i)).norm() - ac) > ObjectTuning::kInPlace)
            continue;
          if (std::abs((points.col(k) - points.col(j)).norm() - bc) > ObjectTuning::kInPlace)
            continue;
          checks -= ObjectTuning::kChecksOfATry;
          try_three(triple.markers, {i, j, k});
        }
      }
    }
    if (most == num_markers()) break;  // another triple would only find it again
  }
  if (frames_ == 0) return best_;
  point_of_marker_ = best_;
  X_WO_ = best_X_WO;
  SettleWithoutOne(points);
  return point_of_marker_;
}

const std::vector<int>& RigidFinder::Follow(const Ref<const Matrix3Xd>& points) {
  point_of_marker_.assign(static_cast<std::size_t>(num_markers()), -1);
  if (frames_ == 0) return point_of_marker_;
  const Eigen::Isometry3d X_WO = X_WO_;
  if (frames_ > 1) X_WO_ = X_WO * last_X_WO_.inverse() * X_WO;
  Complete(points, frames_ > 1 ? ObjectTuning::kAsExpected : ObjectTuning::kAsBefore);
  if (SettleWithoutOne(points)) {
    last_X_WO_ = X_WO;
    ++frames_;
    return point_of_marker_;
  }
  frames_ = 0;
  point_of_marker_.assign(static_cast<std::size_t>(num_markers()), -1);
  return point_of_marker_;
}

}  // namespace mmm_converter
