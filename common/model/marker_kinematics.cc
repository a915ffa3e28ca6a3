// SPDX-License-Identifier: MIT
#include "common/model/marker_kinematics.h"

#include <cassert>
#include <cmath>
#include <utility>

#include "common/math/lanes.h"

namespace mmm_converter {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

// A rotation below this is left out: it moves no marker by more than 1e-12 m.
constexpr double kIdentityTolerance = 1e-12;

/// A rotation A with A e_z = axis, for joints that turn about no coordinate axis.
Matrix3d FrameWithZ(const Vector3d& axis) {
  return Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), axis).toRotationMatrix();
}

/// The rotation whose rows are split over nine lanes, times R, in place.
void RotateLanes(const Matrix3d& R, Lanes* m) {
  for (int row = 0; row < 3; ++row) {
    const Lanes a = m[3 * row];
    const Lanes b = m[3 * row + 1];
    const Lanes c = m[3 * row + 2];
    for (int col = 0; col < 3; ++col) {
      m[3 * row + col] = a * R(0, col) + b * R(1, col) + c * R(2, col);
    }
  }
}

/// p += m * t.
void TranslateLanes(const Lanes* m, const Vector3d& t, Lanes* p) {
  for (int row = 0; row < 3; ++row) {
    p[row] += m[3 * row] * t.x() + m[3 * row + 1] * t.y() + m[3 * row + 2] * t.z();
  }
}

/// m = m * Rot(axis, angle).
void TurnLanes(int axis, const Lanes& sine, const Lanes& cosine, Lanes* m) {
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  for (int row = 0; row < 3; ++row) {
    const Lanes a = m[3 * row + u];
    const Lanes b = m[3 * row + v];
    m[3 * row + u] = a * cosine + b * sine;
    m[3 * row + v] = b * cosine - a * sine;
  }
}

constexpr int kLinkLanes = 12;  // nine of the rotation, three of the position

}  // namespace

MarkerKinematics::MarkerKinematics(const KinematicModel& model, std::vector<int> joints,
                                   std::vector<int> markers)
    : joints_(std::move(joints)), markers_(std::move(markers)) {
  const int num_segments = static_cast<int>(model.segments().size());
  std::vector<int> column_of_joint(model.num_joints(), -1);
  lower_.resize(num_joints());
  upper_.resize(num_joints());
  for (int j = 0; j < num_joints(); ++j) {
    column_of_joint[joints_[j]] = j;
    lower_[j] = model.joint(joints_[j]).lower;
    upper_[j] = model.joint(joints_[j]).upper;
  }

  // For every segment the link that carries it and its constant pose X_LS there.
  std::vector<int> link_of_segment(num_segments, 0);
  std::vector<Isometry3d> X_LS(num_segments, Isometry3d::Identity());
  for (int s = 1; s < num_segments; ++s) {
    const Segment& segment = model.segments()[s];
    const Isometry3d X_LF = X_LS[segment.parent] * segment.X_PF;
    const int column = segment.joint < 0 ? -1 : column_of_joint[segment.joint];
    if (column < 0) {
      link_of_segment[s] = link_of_segment[segment.parent];
      X_LS[s] = X_LF;
      continue;
    }
    Link link;
    link.parent = link_of_segment[segment.parent];
    link.column = column;
    Matrix3d R_PF = X_LF.linear();
    int axis = 0;
    if (segment.axis.cwiseAbs().maxCoeff(&axis) > 1 - kIdentityTolerance) {
      link.axis = axis;
      link.sign = segment.axis[axis] > 0 ? 1 : -1;
    } else {
      const Matrix3d A = FrameWithZ(segment.axis);
      R_PF = R_PF * A;
      X_LS[s].linear() = A.transpose();
    }
    link.R_PF = R_PF;
    link.rotated = !R_PF.isIdentity(kIdentityTolerance);
    link.p_PF = X_LF.translation();
    link.translated = link.p_PF.squaredNorm() > 0;
    links_.push_back(link);
    link_of_segment[s] = static_cast<int>(links_.size());
  }

  moves_.setConstant(num_joints(), num_markers(), false);
  for (int m = 0; m < num_markers(); ++m) {
    const ModelMarker& marker = model.markers()[markers_[m]];
    sites_.push_back({link_of_segment[marker.segment], X_LS[marker.segment] * marker.p_SM});
    for (int link = sites_.back().link; link > 0; link = links_[link - 1].parent) {
      moves_(links_[link - 1].column, m) = true;
    }
  }
}

MarkerBatch MarkerKinematics::MakeBatch(int num_samples) const {
  const int rows = PaddedToLanes(num_samples);
  MarkerBatch batch;
  batch.num_samples = num_samples;
  batch.rotation = Eigen::MatrixXd::Zero(rows, 9);
  batch.position = Eigen::MatrixXd::Zero(rows, 3);
  batch.angles = Eigen::MatrixXd::Zero(rows, num_joints());
  batch.markers = Eigen::MatrixXd::Zero(rows, 3 * num_markers());
  batch.links.resize((links_.size() + 1) * kLinkLanes * kLanes);
  return batch;
}

MarkerJacobian MarkerKinematics::MakeJacobian() const {
  MarkerJacobian result;
  result.p_WM = Eigen::Matrix3Xd::Zero(3, num_markers());
  result.J = Eigen::MatrixXd::Zero(3 * num_markers(), num_dofs());
  result.R_WL.resize(links_.size() + 1);
  result.p_WL.resize(links_.size() + 1);
  return result;
}

void MarkerKinematics::ComputeBatch(MarkerBatch* batch) const {
  const int rows = static_cast<int>(batch->rotation.rows());
  assert(rows % kLanes == 0);
  for (int first = 0; first < rows; first += kLanes) ComputeLanes(first, batch);
}

void MarkerKinematics::ComputeLanes(int first, MarkerBatch* batch) const {
  double* scratch = batch->links.data();
  constexpr int kStride = kLinkLanes * kLanes;
  const auto store = [&](int link, const Lanes* m, const Lanes* p) {
    double* target = scratch + link * kStride;
    for (int i = 0; i < 9; ++i) StoreLanes(m[i], target + i * kLanes);
    for (int i = 0; i < 3; ++i) StoreLanes(p[i], target + (9 + i) * kLanes);
  };
  const auto load = [&](int link, Lanes* m, Lanes* p) {
    const double* source = scratch + link * kStride;
    for (int i = 0; i < 9; ++i) m[i] = LoadLanes(source + i * kLanes);
    for (int i = 0; i < 3; ++i) p[i] = LoadLanes(source + (9 + i) * kLanes);
  };

  Lanes m[9];
  Lanes p[3];
  for (int i = 0; i < 9; ++i) m[i] = LoadLanes(&batch->rotation(first, i));
  for (int i = 0; i < 3; ++i) p[i] = LoadLanes(&batch->position(first, i));
  store(0, m, p);
  int current = 0;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const Link& link = links_[i];
    if (link.parent != current) load(link.parent, m, p);
    if (link.translated) TranslateLanes(m, link.p_PF, p);
    if (link.rotated) RotateLanes(link.R_PF, m);
    Lanes sine;
    Lanes cosine;
    SinCos(link.sign * LoadLanes(&batch->angles(first, link.column)), &sine, &cosine);
    TurnLanes(link.axis, sine, cosine, m);
    current = static_cast<int>(i) + 1;
    store(current, m, p);
  }
  for (int k = 0; k < num_markers(); ++k) {
    const Site& site = sites_[k];
    if (site.link != current) load(current = site.link, m, p);
    Lanes q[3] = {p[0], p[1], p[2]};
    TranslateLanes(m, site.p_LM, q);
    for (int i = 0; i < 3; ++i) StoreLanes(q[i], &batch->markers(first, 3 * k + i));
  }
}

void MarkerKinematics::ComputeMarkers(const Vector3d& position, const Matrix3d& R_WS,
                                      const Eigen::Ref<const Eigen::VectorXd>& angles,
                                      MarkerJacobian* result) const {
  result->R_WL[0] = R_WS;
  result->p_WL[0] = position;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const Link& link = links_[i];
    const Matrix3d& R_WP = result->R_WL[link.parent];
    Matrix3d& R = result->R_WL[i + 1];
    result->p_WL[i + 1] = result->p_WL[link.parent] + R_WP * link.p_PF;
    if (link.rotated) {
      R.noalias() = R_WP * link.R_PF;
    } else {
      R = R_WP;
    }
    const double angle = link.sign * angles[link.column];
    const double sine = std::sin(angle);
    const double cosine = std::cos(angle);
    const int u = (link.axis + 1) % 3;
    const int v = (link.axis + 2) % 3;
    const Vector3d a = R.col(u);
    R.col(u) = a * cosine + R.col(v) * sine;
    R.col(v) = R.col(v) * cosine - a * sine;
  }
  for (int k = 0; k < num_markers(); ++k) {
    const Site& site = sites_[k];
    result->p_WM.col(k) = result->p_WL[site.link] + result->R_WL[site.link] * site.p_LM;
  }
}

void MarkerKinematics::ComputeJacobian(const Vector3d& position, const Matrix3d& R_WS,
                                       const Eigen::Ref<const Eigen::VectorXd>& angles,
                                       MarkerJacobian* result) const {
  ComputeMarkers(position, R_WS, angles, result);
  for (int k = 0; k < num_markers(); ++k) {
    const Vector3d p = result->p_WM.col(k);
    result->J.block<3, 3>(3 * k, 0).setIdentity();
    for (int i = 0; i < 3; ++i) {
      result->J.block<3, 1>(3 * k, 3 + i) = R_WS.col(i).cross(p - position);
    }
    for (int link = sites_[k].link; link > 0; link = links_[link - 1].parent) {
      const Link& l = links_[link - 1];
      const Vector3d axis = l.sign * result->R_WL[link].col(l.axis);
      result->J.block<3, 1>(3 * k, 6 + l.column) = axis.cross(p - result->p_WL[link]);
    }
  }
}

}  // namespace mmm_converter
