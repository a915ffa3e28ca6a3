// SPDX-License-Identifier: MIT
#include "common/model/coordinate_map.h"

#include <Eigen/LU>
#include <cassert>
#include <cmath>
#include <numbers>

#include "common/math/rotation.h"

namespace mmm_converter {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Vector6d = Eigen::Matrix<double, 6, 1>;

namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;
// Nearer to the middle turn's quarter, the two other turns are about one axis.
constexpr double kGimbalLock = 1e-7;

/// Axes of which the last may point the other way than the first two tell.
double Handedness(const Matrix3d& turns) { return turns.determinant() > 0 ? 1 : -1; }

/// v with Rot(a_0, v_0) Rot(a_1, v_1) Rot(a_2, v_2) = R that is nearest to `before`.
Vector3d TurnsOf(const Matrix3d& R, const Matrix3d& turns, const Vector3d& before) {
  Matrix3d B = turns;
  const double sign = Handedness(turns);
  B.col(2) *= sign;
  const Matrix3d C = B.transpose() * R * B;  // Rx Ry Rz
  Vector3d v;
  const double cosine = std::hypot(C(1, 2), C(2, 2));
  v[0] = cosine < kGimbalLock ? before[0] : std::atan2(-C(1, 2), C(2, 2));
  const Matrix3d rest =
      Eigen::AngleAxisd(-v[0], Vector3d::UnitX()).toRotationMatrix() * C;  // Ry Rz
  v[1] = std::atan2(rest(0, 2), rest(2, 2));
  v[2] = sign * std::atan2(rest(1, 0), rest(1, 1));
  const auto unwound = [&before](const Vector3d& turned) {
    Vector3d near;
    for (int i = 0; i < 3; ++i) {
      near[i] = before[i] + std::remainder(turned[i] - before[i], kFullTurn);
    }
    return near;
  };
  const Vector3d one = unwound(v);
  const Vector3d other =
      unwound({v[0] + std::numbers::pi, std::numbers::pi - v[1], v[2] + std::numbers::pi});
  return (other - before).squaredNorm() < (one - before).squaredNorm() ? other : one;
}

Matrix3d RotationOf(const Matrix3d& turns, const Vector3d& v) {
  Matrix3d R = Matrix3d::Identity();
  for (int i = 0; i < 3; ++i) R = R * Eigen::AngleAxisd(v[i], turns.col(i)).toRotationMatrix();
  return R;
}

}  // namespace

CoordinateSeries::CoordinateSeries(const KinematicModel& model) : model_(model) {
  assert(model.coordinates() != nullptr);
  const CoordinateMap& map = *model.coordinates();
  values_.resize(static_cast<Eigen::Index>(map.coordinates().size()));
  if (map.root()) of_root_ = map.root()->offset;
  for (std::size_t i = 0; i < map.coordinates().size(); ++i) {
    const ModelCoordinate& one = map.coordinates()[i];
    values_[static_cast<Eigen::Index>(i)] = one.rest;
    if (one.root >= 0) of_root_[one.root] += map.root()->slope[one.root] * one.rest;
    std::vector<int>& joints = joints_.emplace_back();
    for (const ModelCoordinate::Term& term : one.terms) {
      joints.push_back(model.FindJoint(term.joint));
      assert(joints.back() >= 0);
    }
  }
}

void CoordinateSeries::ReadRoot(const Posture& posture) {
  const FreeRoot& root = *model_.coordinates()->root();
  const Eigen::Isometry3d X_WS = Eigen::Translation3d(posture.position) * posture.orientation;
  const Eigen::Isometry3d X_FM = root.X_WF.inverse() * X_WS * root.X_MS.inverse();
  of_root_.head<3>() = TurnsOf(X_FM.linear(), root.turns, of_root_.head<3>());
  of_root_.tail<3>() = root.shifts.inverse() * X_FM.translation();
}

const VectorXd& CoordinateSeries::Next(const Posture& posture) {
  const CoordinateMap& map = *model_.coordinates();
  if (map.root()) ReadRoot(posture);
  for (std::size_t i = 0; i < map.coordinates().size(); ++i) {
    const ModelCoordinate& one = map.coordinates()[i];
    double& value = values_[static_cast<Eigen::Index>(i)];
    if (one.root >= 0) {
      value = (of_root_[one.root] - map.root()->offset[one.root]) / map.root()->slope[one.root];
      continue;
    }
    value = one.constant;
    for (std::size_t t = 0; t < one.terms.size(); ++t) {
      value += one.terms[t].function.Value(posture.joint_angles[joints_[i][t]]);
    }
  }
  return values_;
}

VectorXd CoordinateSeries::Deviations(const Posture& posture, const VectorXd& deviations) const {
  const CoordinateMap& map = *model_.coordinates();
  VectorXd result(values_.size());
  Eigen::Matrix<double, 6, 6> J = Eigen::Matrix<double, 6, 6>::Zero();  // dv / d[position; turn]
  if (map.root()) {
    const FreeRoot& root = *map.root();
    const Matrix3d R_FW = root.X_WF.linear().transpose();
    // Columns: the rate of the body's rotation about M's axes by each turn.
    Matrix3d E;
    Matrix3d after = Matrix3d::Identity();
    for (int i = 2; i >= 0; --i) {
      E.col(i) = after.transpose() * root.turns.col(i);
      after = Eigen::AngleAxisd(of_root_[i], root.turns.col(i)).toRotationMatrix() * after;
    }
    const Vector3d p_SM = root.X_MS.inverse().translation();
    J.topRightCorner<3, 3>() = E.inverse() * root.X_MS.linear();
    J.bottomLeftCorner<3, 3>() = root.shifts.inverse() * R_FW;
    J.bottomRightCorner<3, 3>() =
        -root.shifts.inverse() * R_FW * posture.orientation.toRotationMatrix() * Skew(p_SM);
  }
  const Vector6d of_root = (J.cwiseAbs2() * deviations.head<6>().cwiseAbs2()).cwiseSqrt();
  for (std::size_t i = 0; i < map.coordinates().size(); ++i) {
    const ModelCoordinate& one = map.coordinates()[i];
    double& deviation = result[static_cast<Eigen::Index>(i)];
    if (one.root >= 0) {
      deviation = of_root[one.root] / std::abs(map.root()->slope[one.root]);
      continue;
    }
    double variance = 0;
    for (std::size_t t = 0; t < one.terms.size(); ++t) {
      const int joint = joints_[i][t];
      double slope = 1;
      one.terms[t].function.Value(posture.joint_angles[joint], &slope);
      variance += slope * slope * deviations[6 + joint] * deviations[6 + joint];
    }
    deviation = std::sqrt(variance);
  }
  return result;
}

Posture PostureOf(const KinematicModel& model, const VectorXd& values) {
  const CoordinateMap& map = *model.coordinates();
  Posture posture = ZeroPosture(model);
  posture.joint_angles = RestAngles(model);
  Vector6d v = Vector6d::Zero();
  if (map.root()) v = map.root()->offset;
  for (std::size_t i = 0; i < map.coordinates().size(); ++i) {
    const ModelCoordinate& one = map.coordinates()[i];
    const double value = values[static_cast<Eigen::Index>(i)];
    if (one.root >= 0) {
      v[one.root] += map.root()->slope[one.root] * value;
    } else if (one.terms.size() == 1 && one.terms.front().joint == one.name) {
      posture.joint_angles[model.FindJoint(one.name)] = value;
    }
  }
  if (map.root()) {
    const FreeRoot& root = *map.root();
    Eigen::Isometry3d X_FM = Eigen::Isometry3d::Identity();
    X_FM.linear() = RotationOf(root.turns, v.head<3>());
    X_FM.translation() = root.shifts * v.tail<3>();
    const Eigen::Isometry3d X_WS = root.X_WF * X_FM * root.X_MS;
    posture.position = X_WS.translation();
    posture.orientation = Eigen::Quaterniond(X_WS.linear()).normalized();
  }
  return posture;
}

Posture RestPosture(const KinematicModel& model) {
  const std::vector<ModelCoordinate>& all = model.coordinates()->coordinates();
  VectorXd values(static_cast<Eigen::Index>(all.size()));
  for (std::size_t i = 0; i < all.size(); ++i) values[static_cast<Eigen::Index>(i)] = all[i].rest;
  return PostureOf(model, values);
}

}  // namespace mmm_converter
