// SPDX-License-Identifier: MIT
#include "plugins/s2kf/marker_measurement_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/math/lanes.h"
#include "common/math/rotation.h"

namespace mmm_converter::s2kf {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

/// Rows of R0 Exp(w) for each lane, by Rodrigues' formula; w = 0 needs no case of its own.
void RotateByVectors(const Matrix3d& R0, const Lanes& x, const Lanes& y, const Lanes& z,
                     Lanes* rows) {
  // The smallest square keeps the quotients finite; they are 1 and 1/2 there to the last digit.
  constexpr double kSmallestSquare = 1e-300;
  const Lanes square = x * x + y * y + z * z + kSmallestSquare;
  Lanes half_angle;
  for (int i = 0; i < kLanes; ++i) half_angle[i] = 0.5 * std::sqrt(square[i]);
  Lanes sine;
  Lanes cosine;
  SinCos(half_angle, &sine, &cosine);
  const Lanes quotient = sine / half_angle;
  const Lanes a = quotient * cosine;          // sin(w)/w
  const Lanes b = 0.5 * quotient * quotient;  // (1 - cos(w))/w^2
  const Lanes E[9] = {1 - b * (y * y + z * z), b * x * y - a * z,       b * x * z + a * y,
                      b * x * y + a * z,       1 - b * (x * x + z * z), b * y * z - a * x,
                      b * x * z - a * y,       b * y * z + a * x,       1 - b * (x * x + y * y)};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      rows[3 * r + c] = R0(r, 0) * E[c] + R0(r, 1) * E[3 + c] + R0(r, 2) * E[6 + c];
    }
  }
}

/// Rows of Rz(yaw) Ry(pitch) Rx(roll) for each lane.
void RotateByRpy(const Lanes& roll, const Lanes& pitch, const Lanes& yaw, Lanes* rows) {
  Lanes sr;
  Lanes cr;
  Lanes sp;
  Lanes cp;
  Lanes sy;
  Lanes cy;
  SinCos(roll, &sr, &cr);
  SinCos(pitch, &sp, &cp);
  SinCos(yaw, &sy, &cy);
  rows[0] = cy * cp;
  rows[1] = cy * sp * sr - sy * cr;
  rows[2] = cy * sp * cr + sy * sr;
  rows[3] = sy * cp;
  rows[4] = sy * sp * sr + cy * cr;
  rows[5] = sy * sp * cr - cy * sr;
  rows[6] = -sp;
  rows[7] = cp * sr;
  rows[8] = cp * cr;
}

/// Body angular rate of d(rpy)/dt: R^T dR = [E d(rpy)].
Matrix3d BodyRateOfRpy(const Vector3d& rpy) {
  const double sr = std::sin(rpy.x());
  const double cr = std::cos(rpy.x());
  const double sp = std::sin(rpy.y());
  const double cp = std::cos(rpy.y());
  Matrix3d E;
  E << 1, 0, -sp, 0, cr, cp * sr, 0, -sr, cp * cr;
  return E;
}

}  // namespace

MarkerMeasurementModel::MarkerMeasurementModel(const MarkerKinematics& kinematics,
                                               JointLimitTransform transform, RootParameters root,
                                               const MatrixXd& half_samples)
    : kinematics_(kinematics),
      transform_(std::move(transform)),
      root_(root),
      num_pairs_(static_cast<int>(half_samples.cols())),
      rows_(num_pairs_ == 0 ? 0 : PaddedToLanes(num_pairs_ + 1)),
      at_(kinematics.MakeJacobian()),
      angles_(kinematics.num_joints()),
      H_(MatrixXd::Zero(num_coordinates(), num_states())),
      mean_of_even_(num_coordinates()) {
  samples_.setZero(rows_, num_states());
  if (num_pairs_ > 0) samples_.topRows(num_pairs_) = half_samples.transpose();
  offsets_.setZero(rows_, num_states());
  batch_ = kinematics.MakeBatch(2 * rows_);
}

void MarkerMeasurementModel::ComputeMoments(const Belief& belief, const VectorXd& center,
                                            const MatrixXd& spread, bool with_covariance,
                                            MeasurementMoments* moments) {
  if (num_pairs_ > 0) {
    ComputeSampled(belief, center, spread, with_covariance, moments);
  } else {
    ComputeLinearized(belief, center, spread, with_covariance, moments);
  }
}

void MarkerMeasurementModel::PlaceRoots(const Belief& belief, const VectorXd& center) {
  const Matrix3d R0 = belief.orientation.toRotationMatrix();
  for (int half = 0; half < 2; ++half) {
    const double sign = half == 0 ? 1 : -1;
    for (int row = 0; row < rows_; row += kLanes) {
      const int target = half * rows_ + row;
      Lanes o[3];
      for (int i = 0; i < 3; ++i) {
        const double middle = center[3 + i] + (root_ == RootParameters::kRpy ? belief.rpy[i] : 0);
        o[i] = middle + sign * LoadLanes(&offsets_(row, 3 + i));
        StoreLanes(belief.position[i] + center[i] + sign * LoadLanes(&offsets_(row, i)),
                   &batch_.position(target, i));
      }
      Lanes rows[9];
      if (root_ == RootParameters::kRpy) {
        RotateByRpy(o[0], o[1], o[2], rows);
      } else {
        RotateByVectors(R0, o[0], o[1], o[2], rows);
      }
      for (int i = 0; i < 9; ++i) StoreLanes(rows[i], &batch_.rotation(target, i));
    }
  }
}

void MarkerMeasurementModel::PlaceAngles(const Belief& belief, const VectorXd& center) {
  for (int j = 0; j < kinematics_.num_joints(); ++j) {
    const double mean = belief.parameters[j] + center[6 + j];
    const double half_range = transform_.half_range()[j];
    const double middle = transform_.middle()[j];
    if (transform_.function() == LimitFunction::kTanh) {
      for (int row = 0; row < rows_; ++row) {
        batch_.angles(row, j) = transform_.Angle(j, mean + offsets_(row, 6 + j));
        batch_.angles(rows_ + row, j) = transform_.Angle(j, mean - offsets_(row, 6 + j));
      }
      continue;
    }
    // sin(mean +- d) = sin(mean) cos(d) +- cos(mean) sin(d): one evaluation for a pair.
    const double a = half_range * std::sin(mean);
    const double b = half_range * std::cos(mean);
    for (int row = 0; row < rows_; row += kLanes) {
      Lanes sine;
      Lanes cosine;
      SinCos(LoadLanes(&offsets_(row, 6 + j)), &sine, &cosine);
      const Lanes even = middle + a * cosine;
      const Lanes odd = b * sine;
      StoreLanes(even + odd, &batch_.angles(row, j));
      StoreLanes(even - odd, &batch_.angles(rows_ + row, j));
    }
  }
}

void MarkerMeasurementModel::ComputeSampled(const Belief& belief, const VectorXd& center,
                                            const MatrixXd& spread, bool with_covariance,
                                            MeasurementMoments* moments) {
  offsets_.noalias() = samples_ * spread.transpose();
  PlaceRoots(belief, center);
  PlaceAngles(belief, center);
  kinematics_.ComputeBatch(&batch_);

  // With z+- = z0 + e +- o for each pair, all moments are sums over e and o, and nothing cancels.
  const int m = num_coordinates();
  auto odd = batch_.markers.topRows(rows_);
  auto even = batch_.markers.bottomRows(rows_);
  const double weight = 2.0 / (2 * num_pairs_ + 1);
  for (int i = 0; i < m; ++i) {
    double* plus = &batch_.markers(0, i);
    double* minus = plus + rows_;
    const double z0 = plus[num_pairs_];
    Lanes sum = Broadcast(0);
    Lanes squares = Broadcast(0);
    for (int row = 0; row < rows_; row += kLanes) {
      const Lanes p = LoadLanes(plus + row);
      const Lanes q = LoadLanes(minus + row);
      const Lanes o = 0.5 * (p - q);
      const Lanes e = 0.5 * (p + q) - z0;
      StoreLanes(o, plus + row);
      StoreLanes(e, minus + row);
      sum += e;
      squares += o * o + e * e;
    }
    double mean = 0;
    double variance = 0;
    for (int lane = 0; lane < kLanes; ++lane) {
      mean += weight * sum[lane];
      variance += weight * squares[lane];
    }
    moments->mean[i] = z0 + mean;
    mean_of_even_[i] = mean;
    moments->residual[i] = variance - mean * mean;
  }
  moments->C_zs.noalias() = weight * odd.transpose() * samples_;
  for (int i = 0; i < m; ++i) {
    moments->residual[i] = std::max(0.0, moments->residual[i] - moments->C_zs.row(i).squaredNorm());
  }
  if (!with_covariance) return;
  moments->C_zz.resize(m, m);
  moments->C_zz.setZero();
  auto C_zz = moments->C_zz.selfadjointView<Eigen::Lower>();
  C_zz.rankUpdate(odd.transpose(), weight);
  C_zz.rankUpdate(even.transpose(), weight);
  C_zz.rankUpdate(mean_of_even_, -1.0);
}

void MarkerMeasurementModel::ComputeLinearized(const Belief& belief, const VectorXd& center,
                                               const MatrixXd& spread, bool with_covariance,
                                               MeasurementMoments* moments) {
  const Vector3d o = center.segment<3>(3);
  Matrix3d R;
  Matrix3d rate;  // d(body rotation) / d(o)
  if (root_ == RootParameters::kRpy) {
    R = RotationFromRpy(belief.rpy + o);
    rate = BodyRateOfRpy(belief.rpy + o);
  } else {
    R = (belief.orientation * Exp(o)).toRotationMatrix();
    rate = RightJacobian(o);
  }
  for (int j = 0; j < kinematics_.num_joints(); ++j) {
    angles_[j] = transform_.Angle(j, belief.parameters[j] + center[6 + j]);
  }
  kinematics_.ComputeJacobian(belief.position + center.head<3>(), R, angles_, &at_);
  H_.leftCols<3>() = at_.J.leftCols<3>();
  H_.middleCols<3>(3).noalias() = at_.J.middleCols<3>(3) * rate;
  for (int j = 0; j < kinematics_.num_joints(); ++j) {
    H_.col(6 + j) = transform_.Slope(j, belief.parameters[j] + center[6 + j]) * at_.J.col(6 + j);
  }
  moments->mean = at_.p_WM.reshaped();
  moments->C_zs.noalias() = H_ * spread;
  moments->residual.setZero();
  if (!with_covariance) return;
  moments->C_zz.resize(num_coordinates(), num_coordinates());
  moments->C_zz.setZero();
  moments->C_zz.selfadjointView<Eigen::Lower>().rankUpdate(moments->C_zs);
}

}  // namespace mmm_converter::s2kf
