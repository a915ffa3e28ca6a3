// SPDX-License-Identifier: MIT
#include "common/math/rotation.h"

#include <Eigen/SVD>

#include <cmath>
#include <numbers>

namespace mmm_converter {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

Matrix3d RotationFromRpy(const Vector3d& rpy) {
  return (Eigen::AngleAxisd(rpy.z(), Vector3d::UnitZ()) *
          Eigen::AngleAxisd(rpy.y(), Vector3d::UnitY()) *
          Eigen::AngleAxisd(rpy.x(), Vector3d::UnitX()))
      .toRotationMatrix();
}

Vector3d RpyFromRotation(const Matrix3d& R) {
  const double cos_pitch = std::hypot(R(0, 0), R(1, 0));
  // Below this, roll and yaw are not separable in double precision.
  constexpr double kGimbalLock = 1e-9;
  if (cos_pitch < kGimbalLock) {
    return {0.0, std::atan2(-R(2, 0), cos_pitch), std::atan2(-R(0, 1), R(1, 1))};
  }
  return {std::atan2(R(2, 1), R(2, 2)), std::atan2(-R(2, 0), cos_pitch),
          std::atan2(R(1, 0), R(0, 0))};
}

Vector3d ContinuousRpy(const Vector3d& rpy, const Vector3d& previous) {
  constexpr double kPi = std::numbers::pi;
  const auto nearest = [&](Vector3d angles) {
    for (int i = 0; i < 3; ++i) {
      angles[i] += 2 * kPi * std::round((previous[i] - angles[i]) / (2 * kPi));
    }
    return angles;
  };
  const Vector3d a = nearest(rpy);
  const Vector3d b = nearest({rpy.x() + kPi, kPi - rpy.y(), rpy.z() + kPi});
  return (a - previous).squaredNorm() <= (b - previous).squaredNorm() ? a : b;
}

const Vector3d& RpySeries::Next(const Eigen::Quaterniond& orientation) {
  const Vector3d principal = RpyFromRotation(orientation.toRotationMatrix());
  rpy_ = is_first_ ? principal : ContinuousRpy(principal, rpy_);
  is_first_ = false;
  return rpy_;
}

Quaterniond Exp(const Vector3d& w) {
  const double angle = w.norm();
  // sin(a/2)/a by its series below 1e-4: the next term is 1e-18 relative.
  const double scale = angle < 1e-4 ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
  Quaterniond q(std::cos(0.5 * angle), scale * w.x(), scale * w.y(), scale * w.z());
  return q.normalized();
}

Vector3d Log(const Quaterniond& q) {
  const double sign = q.w() < 0 ? -1.0 : 1.0;
  const double sine = q.vec().norm();
  const double half_angle = std::atan2(sine, sign * q.w());
  const double scale = sine < 1e-9 ? 2.0 : 2.0 * half_angle / sine;
  return sign * scale * q.vec();
}

Matrix3d RightJacobian(const Vector3d& w) {
  const double angle2 = w.squaredNorm();
  const double angle = std::sqrt(angle2);
  const Matrix3d W = Skew(w);
  // Series below 1e-3: the next terms are below 1e-14.
  const double a = angle < 1e-3 ? 0.5 - angle2 / 24 : (1 - std::cos(angle)) / angle2;
  const double b =
      angle < 1e-3 ? 1.0 / 6 - angle2 / 120 : (angle - std::sin(angle)) / (angle2 * angle);
  return Matrix3d::Identity() - a * W + b * W * W;
}

Matrix3d RotationBetween(const Vector3d& a, const Vector3d& b) {
  return Quaterniond::FromTwoVectors(a, b).toRotationMatrix();
}

Matrix3d NearestRotation(const Matrix3d& M) {
  const Eigen::JacobiSVD<Matrix3d> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double handedness = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  return svd.matrixU() * Vector3d(1, 1, handedness < 0 ? -1 : 1).asDiagonal() *
         svd.matrixV().transpose();
}

Matrix3d Skew(const Vector3d& w) {
  Matrix3d W;
  W << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  return W;
}

}  // namespace mmm_converter
