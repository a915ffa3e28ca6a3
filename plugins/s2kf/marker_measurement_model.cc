// SPDX-License-Identifier: MIT
#include "plugins/s2kf/marker_measurement_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/math/dense.h"
#include "common/math/rotation.h"
#include "plugins/s2kf/sample_kernels.h"

namespace mmm_converter::s2kf {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr KernelTables<SampleKernels> kKernelTables = MMM_CONVERTER_KERNEL_TABLES(SampleKernels);

/// Rows for the pairs and the centre; never so many that the columns of both halves lie a multiple
/// of 4096 bytes apart, which would let them all compete for the same few cache lines.
int HalfRows(int num_pairs) {
  const int rows = PaddedSize(num_pairs + 1);
  return rows % 256 == 0 ? rows + kPadding : rows;
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
      kernels_(kKernelTables.For(ActiveInstructionSet())),
      num_pairs_(static_cast<int>(half_samples.cols())),
      rows_(num_pairs_ == 0 ? 0 : HalfRows(num_pairs_)),
      half_samples_(num_states(), rows_),
      samples_(rows_, num_states()),
      offsets_(rows_, num_states()),
      batch_(kinematics.MakeBatch(2 * rows_)),
      mean_of_even_(num_coordinates(), 1),
      at_(kinematics.MakeJacobian()),
      angles_(kinematics.num_joints()),
      slopes_(kinematics.num_joints()),
      spread_transposed_(num_states(), num_states()) {
  half_samples_.view().leftCols(num_pairs_) = half_samples;
  samples_.view().topRows(num_pairs_) = half_samples.transpose();
}

void MarkerMeasurementModel::ComputeMoments(const Belief& belief, const VectorXd& center,
                                            const SpreadRoot& spread, bool with_covariance,
                                            MeasurementMoments* moments) {
  if (num_pairs_ > 0) {
    ComputeSampled(belief, center, spread, with_covariance, moments);
  } else {
    ComputeLinearized(belief, center, spread, with_covariance, moments);
  }
}

void MarkerMeasurementModel::PlaceRoots(const Belief& belief, const VectorXd& center) {
  const bool is_rpy = root_ == RootParameters::kRpy;
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> R0 = belief.orientation.toRotationMatrix();
  Eigen::Matrix<double, 6, 1> base = center.head<6>();
  base.head<3>() += belief.position;
  if (is_rpy) base.tail<3>() += belief.rpy;
  kernels_.place_roots({is_rpy, R0.data(), base.data(), offsets_.data(), batch_.position.data(),
                        batch_.rotation.data(), rows_});
}

void MarkerMeasurementModel::PlaceAngles(const Belief& belief, const VectorXd& center) {
  for (int j = 0; j < kinematics_.num_joints(); ++j) {
    const double mean = belief.parameters[j] + center[6 + j];
    const double* offsets = offsets_.col(6 + j);
    double* plus = batch_.angles.col(j);
    double* minus = plus + rows_;
    if (transform_.function() == LimitFunction::kTanh || transform_.is_linear(j)) {
      for (int row = 0; row < rows_; ++row) {
        plus[row] = transform_.Angle(j, mean + offsets[row]);
        minus[row] = transform_.Angle(j, mean - offsets[row]);
      }
      continue;
    }
    // sin(mean +- d) = sin(mean) cos(d) +- cos(mean) sin(d): one evaluation for a pair.
    const double half_range = transform_.half_range()[j];
    kernels_.place_angles(transform_.middle()[j], half_range * std::sin(mean),
                          half_range * std::cos(mean), offsets, plus, minus, rows_);
  }
}

void MarkerMeasurementModel::ComputeSampled(const Belief& belief, const VectorXd& center,
                                            const SpreadRoot& spread, bool with_covariance,
                                            MeasurementMoments* moments) {
  MultiplyByTransposed(samples_, spread.matrix, &offsets_,
                       spread.is_lower ? Shape::kUpperRight : Shape::kFull);
  PlaceRoots(belief, center);
  PlaceAngles(belief, center);
  kinematics_.ComputeBatch(&batch_);

  const int m = num_coordinates();
  const double weight = 2.0 / (2 * num_pairs_ + 1);
  for (int i = 0; i < m; ++i) {
    double* plus = batch_.markers.col(i);
    const double z0 = plus[num_pairs_];
    const PairSums sums = kernels_.fold(z0, plus, plus + rows_, rows_);
    const double mean = weight * sums.even;
    moments->mean[i] = z0 + mean;
    mean_of_even_.data()[i] = mean;
    moments->residual[i] = weight * sums.squares - mean * mean;
  }
  Multiply(weight, half_samples_, batch_.markers, &moments->C_sz);
  for (int i = 0; i < m; ++i) {
    const double explained = moments->C_sz.view().col(i).squaredNorm();
    moments->residual[i] = std::max(0.0, moments->residual[i] - explained);
  }
  if (!with_covariance) return;
  if (parts_.rows() == 0) parts_ = PaddedMatrix(m, 2 * rows_);
  parts_.view() = batch_.markers.view().transpose();
  moments->ClearCovariance();
  AddSquare(weight, parts_, &moments->C_zz);
  AddSquare(-1, mean_of_even_, &moments->C_zz);
}

void MarkerMeasurementModel::ComputeLinearized(const Belief& belief, const VectorXd& center,
                                               const SpreadRoot& spread, bool with_covariance,
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
    const double parameter = belief.parameters[j] + center[6 + j];
    angles_[j] = transform_.Angle(j, parameter);
    slopes_[j] = transform_.Slope(j, parameter);
  }
  kinematics_.ComputeMarkers(belief.position + center.head<3>(), R, angles_, &at_);
  kinematics_.ComputeJacobian(&at_);
  moments->mean = at_.p_WM.reshaped();
  // C_sz = spread^T D J^T: angles and the body's rotation are functions of the state, with slope D.
  auto weighted = spread_transposed_.view();
  weighted = spread.matrix.view().transpose();
  weighted.middleCols<3>(3) =
      spread.matrix.view().middleRows<3>(3).transpose().lazyProduct(rate.transpose());
  for (int j = 0; j < kinematics_.num_joints(); ++j) weighted.col(6 + j) *= slopes_[j];
  const bool is_upper = spread.is_lower && rate.isIdentity(0);
  Multiply(1, spread_transposed_, at_.J_transposed, &moments->C_sz,
           is_upper ? Shape::kUpperLeft : Shape::kFull);
  moments->residual.setZero();
  if (!with_covariance) return;
  if (parts_.rows() == 0) parts_ = PaddedMatrix(num_coordinates(), num_states());
  parts_.view() = moments->C_sz.view().transpose();
  moments->ClearCovariance();
  AddSquare(1, parts_, &moments->C_zz);
}

}  // namespace mmm_converter::s2kf
