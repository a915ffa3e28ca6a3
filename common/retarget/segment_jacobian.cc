// SPDX-License-Identifier: MIT
#include "common/retarget/segment_jacobian.h"

#include <algorithm>

#include "common/math/rotation.h"

namespace mmm_converter {
namespace {

void Begin(std::size_t columns, SegmentJacobian::Rows* rows) {
  const auto count = static_cast<Eigen::Index>(columns);
  if (rows->cols() < count) rows->resize(3, count);
  rows->leftCols(count).setZero();
}

}  // namespace

SegmentJacobian::SegmentJacobian(const KinematicModel& model) : model_(model) {
  const auto& segments = model.segments();
  const auto count = segments.size();
  X_WS_.resize(count);
  axes_.assign(count, Eigen::Vector3d::Zero());
  columns_.resize(count);
  movers_.resize(count);
  const int first = model.is_root_fixed() ? 6 : 0;
  for (std::size_t s = 0; s < count; ++s) {
    std::vector<int>& columns = columns_[s];
    for (int i = first; i < 6; ++i) columns.push_back(i);
    std::vector<int> moving;
    for (int at = static_cast<int>(s); at >= 0; at = segments[at].parent) {
      if (segments[at].joint < 0) continue;
      moving.push_back(at);
      columns.push_back(6 + segments[at].joint);
    }
    std::sort(columns.begin(), columns.end());
    columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
    for (const int at : moving) {
      const auto place = std::lower_bound(columns.begin(), columns.end(), 6 + segments[at].joint);
      movers_[s].push_back({at, static_cast<int>(place - columns.begin())});
    }
  }
}

void SegmentJacobian::Compute(const Posture& posture) {
  const auto& segments = model_.segments();
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const Segment& segment = segments[s];
    Eigen::Isometry3d& X = X_WS_[s];
    if (segment.parent < 0) {
      X.linear() = posture.orientation.toRotationMatrix();
      X.translation() = posture.position;
      X.makeAffine();
      continue;
    }
    X = X_WS_[segment.parent] * segment.X_PF;
    if (segment.joint < 0) continue;
    const double q = posture.joint_angles[segment.joint];
    double slope = 1;
    if (segment.function) segment.function->Value(q, &slope);
    axes_[s] = slope * (X.linear() * segment.axis);
    X = X * JointTransform(segment, q);
  }
}

void SegmentJacobian::OfPoint(int segment, const Eigen::Vector3d& p_W, Rows* rows) const {
  Begin(columns_[segment].size(), rows);
  if (!model_.is_root_fixed()) {
    const Eigen::Isometry3d& root = X_WS_[0];
    rows->leftCols<3>().setIdentity();
    rows->middleCols<3>(3) = -Skew(p_W - root.translation()) * root.linear();
  }
  for (const Mover& mover : movers_[segment]) {
    const bool slides = model_.segments()[mover.segment].type == JointType::kSliding;
    if (slides) {
      rows->col(mover.place) += axes_[mover.segment];
    } else {
      rows->col(mover.place) +=
          axes_[mover.segment].cross(p_W - X_WS_[mover.segment].translation());
    }
  }
}

void SegmentJacobian::OfDirection(int segment, const Eigen::Vector3d& d_W, Rows* rows) const {
  Begin(columns_[segment].size(), rows);
  if (!model_.is_root_fixed()) rows->middleCols<3>(3) = -Skew(d_W) * X_WS_[0].linear();
  for (const Mover& mover : movers_[segment]) {
    if (model_.segments()[mover.segment].type == JointType::kSliding) continue;
    rows->col(mover.place) += axes_[mover.segment].cross(d_W);
  }
}

}  // namespace mmm_converter
