// SPDX-License-Identifier: MIT
#include "common/model/marker_kinematics.h"

#include <cmath>
#include <utility>

#include "common/math/rotation.h"
#include "common/model/untold_joints.h"

namespace mmm_converter {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

// A rotation below this is left out: it moves no marker by more than 1e-12 m.
constexpr double kIdentityTolerance = 1e-12;

Eigen::Map<const Matrix3d> Rotation(const TrackedLink& link) {
  return Eigen::Map<const Matrix3d>(link.R_PF);
}
Eigen::Map<const Vector3d> Translation(const TrackedLink& link) {
  return Eigen::Map<const Vector3d>(link.p_PF);
}
Eigen::Map<const Vector3d> Slide(const TrackedLink& link) {
  return Eigen::Map<const Vector3d>(link.slide_P);
}

/// A joint that is not tracked is where the model's frames have it.
bool IsAtRest(const Segment& segment) {
  return segment.joint < 0 ||
         (segment.leader < 0 && segment.rest == 0 && segment.function == nullptr);
}

double RestOf(const KinematicModel& model, const Segment& segment) {
  return model.joint(segment.joint).rest;
}

}  // namespace

MarkerKinematics::MarkerKinematics(const KinematicModel& model, std::vector<int> joints,
                                   const std::vector<MarkerIx>& markers)
    : MarkerKinematics(model, std::move(joints), markers, UntoldJoints(model, markers)) {}

MarkerKinematics::MarkerKinematics(const KinematicModel& model, std::vector<int> joints,
                                   std::vector<MarkerIx> markers, const std::vector<int>& resting)
    : joints_(std::move(joints)),
      markers_(std::move(markers)),
      is_root_fixed_(model.is_root_fixed()),
      X_WS_(is_root_fixed_ ? model.segments().front().X_PF : Isometry3d::Identity()) {
  const int num_segments = static_cast<int>(model.segments().size());
  std::vector<int> column_of_joint(model.num_joints(), -1);
  lower_.resize(num_joints());
  upper_.resize(num_joints());
  rest_.resize(num_joints());
  reach_.resize(num_joints());
  for (int j = 0; j < num_joints(); ++j) {
    const Segment& joint = model.joint(joints_[j]);
    column_of_joint[joints_[j]] = j;
    lower_[j] = joint.lower;
    upper_[j] = joint.upper;
    rest_[j] = joint.rest;
    reach_[j] = joint.reach;
  }
  for (const int joint : resting) column_of_joint[joint] = -1;

  std::vector<bool> is_shown(num_segments, false);  // by a marker on it, or on what it carries
  for (const MarkerIx marker : markers_) {
    for (int s = model.markers()[marker].segment; s >= 0; s = model.segments()[s].parent) {
      is_shown[s] = true;
    }
  }

  // For every segment the link that carries it and its constant pose X_LS there.
  links_.emplace_back();
  segment_of_link_.push_back(0);
  std::vector<int> link_of_segment(num_segments, 0);
  std::vector<Isometry3d> X_LS(num_segments, Isometry3d::Identity());
  for (int s = 1; s < num_segments; ++s) {
    const Segment& segment = model.segments()[s];
    const Isometry3d X_LF = X_LS[segment.parent] * segment.X_PF;
    const int column = segment.joint < 0 ? -1 : column_of_joint[segment.joint];
    const bool is_plain = segment.leader < 0 && segment.function == nullptr;
    if (column < 0 || (!is_plain && !is_shown[s])) {
      const int link = link_of_segment[segment.parent];
      link_of_segment[s] = link;
      if (link > 0 && segment_of_link_[link] == segment.parent) segment_of_link_[link] = s;
      X_LS[s] = IsAtRest(segment) ? X_LF : X_LF * JointTransform(segment, RestOf(model, segment));
      continue;
    }
    TrackedLink link = MakeLink(segment, column, X_LF, &X_LS[s]);
    link.parent = link_of_segment[segment.parent];
    link_of_segment[s] = static_cast<int>(links_.size());
    links_[link.parent].kept |= link.parent + 1 < link_of_segment[s];
    links_.push_back(link);
    segment_of_link_.push_back(s);
  }

  for (const double upper : upper_) turns_freely_.push_back(std::isinf(upper));
  for (std::size_t l = 1; l < links_.size(); ++l) {
    const TrackedLink& link = links_[l];
    const bool is_angle = link.column < num_joints() && std::abs(link.slope) == 1;
    if (link.slides || !is_angle) turns_freely_[JointOfColumn(link.column)] = false;
  }
  moves_.setConstant(num_joints(), num_markers(), false);
  std::vector<Vector3d> p_LM;
  for (int m = 0; m < num_markers(); ++m) {
    const ModelMarker& marker = model.markers()[markers_[m]];
    link_of_marker_.push_back(link_of_segment[marker.segment]);
    p_LM.emplace_back(X_LS[marker.segment] * marker.p_SM);
    for (int link = link_of_marker_[m]; link > 0; link = links_[link].parent) {
      moves_(JointOfColumn(links_[link].column), m) = true;
    }
  }
  for (std::size_t l = 0; l < links_.size(); ++l) {
    links_[l].first_site = static_cast<int>(sites_.size());
    for (int m = 0; m < num_markers(); ++m) {
      if (link_of_marker_[m] != static_cast<int>(l)) continue;
      sites_.push_back({m, {p_LM[m].x(), p_LM[m].y(), p_LM[m].z()}});
      ++links_[l].num_sites;
    }
  }
}

/// A link that moves by the segment's joint; X_LS: the segment's constant pose in it.
TrackedLink MarkerKinematics::MakeLink(const Segment& segment, int column, const Isometry3d& X_LF,
                                       Isometry3d* X_LS) {
  TrackedLink link;
  link.column = column;
  Isometry3d X = X_LF;
  double slope = 1;
  is_plain_ = is_plain_ && segment.leader < 0 && segment.type == JointType::kRevolute;
  if (segment.function) {
    if (const auto line = segment.function->AsLine()) {
      Segment offset = segment;
      offset.function = nullptr;
      X = X * JointTransform(offset, line->offset);
      slope = line->slope;
    } else {
      link.column = num_joints() + static_cast<int>(functions_.size());
      functions_.push_back({column, segment.function});
    }
    is_plain_ = false;
  }
  Matrix3d R_PF = X.linear();
  int axis = 0;
  if (segment.type == JointType::kSliding) {
    link.slides = true;
    Eigen::Map<Vector3d>(link.slide_P) = slope * (R_PF * segment.axis);
  } else if (segment.axis.cwiseAbs().maxCoeff(&axis) > 1 - kIdentityTolerance) {
    link.axis = axis;
    link.slope = segment.axis[axis] > 0 ? slope : -slope;
  } else {
    const Matrix3d A = RotationBetween(Vector3d::UnitZ(), segment.axis);
    R_PF = R_PF * A;
    X_LS->linear() = A.transpose();
    link.slope = slope;
  }
  link.rotated = !R_PF.isIdentity(kIdentityTolerance);
  link.translated = X.translation().squaredNorm() > 0;
  Eigen::Map<Matrix3d>(link.R_PF) = R_PF;
  Eigen::Map<Vector3d>(link.p_PF) = X.translation();
  return link;
}

std::vector<int> MarkerKinematics::RestingJoints() const {
  std::vector<int> resting;
  for (int j = 0; j < num_joints(); ++j) {
    if (!IsEndless(j) && !moves_.row(j).any()) resting.push_back(j);
  }
  return resting;
}

MarkerKinematics MarkerKinematics::WithMarkersMoved(const Eigen::Matrix3Xd& offsets) const {
  MarkerKinematics moved = *this;
  for (MarkerSite& site : moved.sites_) {
    Eigen::Map<Vector3d>(site.p_LM) += offsets.col(site.marker);
  }
  return moved;
}

MarkerBatch MarkerKinematics::MakeBatch(int num_samples) const {
  MarkerBatch batch;
  batch.rotation = PaddedMatrix(num_samples, 9);
  batch.position = PaddedMatrix(num_samples, 3);
  batch.angles = PaddedMatrix(num_samples, num_joints() + static_cast<int>(functions_.size()));
  batch.markers = PaddedMatrix(num_samples, 3 * num_markers());
  batch.frames = PaddedMatrix(kFrameSize, static_cast<int>(links_.size()));
  return batch;
}

MarkerJacobian MarkerKinematics::MakeJacobian() const {
  MarkerJacobian result;
  result.p_WM = Eigen::Matrix3Xd::Zero(3, num_markers());
  result.J_transposed = PaddedMatrix(num_dofs(), 3 * num_markers());
  result.R_WL.resize(links_.size());
  result.p_WL.resize(links_.size());
  result.values.setZero(num_joints() + static_cast<int>(functions_.size()));
  result.slopes.setOnes(result.values.size());
  return result;
}

void MarkerKinematics::ComputeBatch(MarkerBatch* batch, InstructionSet set) const {
  static constexpr KernelTables<MarkerKernels> kTables = MMM_CONVERTER_KERNEL_TABLES(MarkerKernels);
  const MarkerBatchColumns columns = {batch->rotation.data(), batch->position.data(),
                                      batch->angles.data(),   batch->markers.data(),
                                      batch->frames.data(),   batch->rotation.padded_rows()};
  const MarkerKernels& kernels = kTables.For(set);
  for (std::size_t i = 0; i < functions_.size(); ++i) {
    functions_[i].function->Values(batch->angles.col(functions_[i].joint),
                                   batch->angles.padded_rows(),
                                   batch->angles.col(num_joints() + static_cast<int>(i)));
  }
  (is_plain_ ? kernels.place_markers : kernels.place_markers_of_slides)(
      links_.data(), static_cast<int>(links_.size()), sites_.data(), columns);
}

const double* MarkerKinematics::ComputeFunctions(const Eigen::Ref<const Eigen::VectorXd>& angles,
                                                 MarkerJacobian* result) const {
  result->values.head(num_joints()) = angles;
  for (std::size_t i = 0; i < functions_.size(); ++i) {
    const auto column = num_joints() + static_cast<Eigen::Index>(i);
    const double angle = angles[functions_[i].joint];
    result->values[column] = functions_[i].function->Value(angle, &result->slopes[column]);
  }
  return result->values.data();
}

void MarkerKinematics::ComputeMarkers(const Vector3d& position, const Matrix3d& R_WS,
                                      const Eigen::Ref<const Eigen::VectorXd>& angles,
                                      MarkerJacobian* result) const {
  result->R_WL[0] = R_WS;
  result->p_WL[0] = position;
  const double* values = functions_.empty() ? angles.data() : ComputeFunctions(angles, result);
  for (std::size_t i = 1; i < links_.size(); ++i) {
    const TrackedLink& link = links_[i];
    const Matrix3d& R_WP = result->R_WL[link.parent];
    Matrix3d& R = result->R_WL[i];
    result->p_WL[i] = result->p_WL[link.parent] + R_WP * Translation(link);
    if (link.rotated) {
      R.noalias() = R_WP * Rotation(link);
    } else {
      R = R_WP;
    }
    if (link.slides) {
      result->p_WL[i] += R_WP * (values[link.column] * Slide(link));
      continue;
    }
    const double angle = link.slope * values[link.column];
    const double sine = std::sin(angle);
    const double cosine = std::cos(angle);
    const int u = (link.axis + 1) % 3;
    const int v = (link.axis + 2) % 3;
    const Vector3d a = R.col(u);
    R.col(u) = a * cosine + R.col(v) * sine;
    R.col(v) = R.col(v) * cosine - a * sine;
  }
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const TrackedLink& link = links_[i];
    for (int s = link.first_site; s < link.first_site + link.num_sites; ++s) {
      const Eigen::Map<const Vector3d> p_LM(sites_[s].p_LM);
      result->p_WM.col(sites_[s].marker) = result->p_WL[i] + result->R_WL[i] * p_LM;
    }
  }
}

void MarkerKinematics::ComputeJacobian(MarkerJacobian* result) const {
  const std::ptrdiff_t stride = result->J_transposed.padded_rows();
  const Matrix3d& R_WS = result->R_WL[0];
  for (int k = 0; k < num_markers(); ++k) {
    const Vector3d p = result->p_WM.col(k);
    double* rows = result->J_transposed.col(3 * k);  // of x, y and z
    const auto set = [&](int dof, const Vector3d& slope) {
      for (int i = 0; i < 3; ++i) rows[i * stride + dof] = slope[i];
    };
    if (!is_root_fixed_) {
      const Vector3d arm = p - result->p_WL[0];
      for (int i = 0; i < 3; ++i) {
        set(i, Vector3d::Unit(i));
        set(3 + i, R_WS.col(i).cross(arm));
      }
    }
    if (!is_plain_) {
      AddSlopes(k, result);
      continue;
    }
    for (int link = link_of_marker_[k]; link > 0; link = links_[link].parent) {
      const TrackedLink& l = links_[link];
      const Vector3d axis = l.slope * result->R_WL[link].col(l.axis);
      set(6 + l.column, axis.cross(p - result->p_WL[link]));
    }
  }
}

/// What the joints move a marker by, where several may move by one angle.
void MarkerKinematics::AddSlopes(int marker, MarkerJacobian* result) const {
  const Vector3d p = result->p_WM.col(marker);
  auto columns = result->J_transposed.view().middleCols<3>(3 * marker);
  for (int link = link_of_marker_[marker]; link > 0; link = links_[link].parent) {
    columns.row(6 + JointOfColumn(links_[link].column)).setZero();
  }
  for (int link = link_of_marker_[marker]; link > 0; link = links_[link].parent) {
    const TrackedLink& l = links_[link];
    const double slope = result->slopes[l.column];
    Vector3d way;
    if (l.slides) {
      way = result->R_WL[l.parent] * Slide(l);
    } else {
      const Vector3d axis = l.slope * result->R_WL[link].col(l.axis);
      way = axis.cross(p - result->p_WL[link]);
    }
    columns.row(6 + JointOfColumn(l.column)) += slope * way.transpose();
  }
}

}  // namespace mmm_converter
