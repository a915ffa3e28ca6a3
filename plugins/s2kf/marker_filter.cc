// SPDX-License-Identifier: MIT
#include "plugins/s2kf/marker_filter.h"

#include <cmath>
#include <limits>

#include "common/fit/posture_fit.h"
#include "common/math/rotation.h"
#include "plugins/s2kf/lcd_sampling.h"

namespace mmm_converter::s2kf {

using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::Ref;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr unsigned kRotationSeed = 1;
// A frame is linearised again while the samples leave more of the marker variance unexplained than
// this share of the measurement noise.
constexpr double kLargestUnexplainedShare = 0.25;

MatrixXd HalfSamples(const S2kfSettings& settings, int n) {
  switch (settings.filter) {
    case FilterType::kS2kf:
      return LcdHalfSamples(n, settings.samples);
    case FilterType::kUkf:
      return RotatedUkfHalfSamples(n, kRotationSeed);
    case FilterType::kEkf:
      break;
  }
  return MatrixXd(n, 0);
}

MotionModel MakeMotionModel(const S2kfSettings& settings, const JointLimitTransform& transform,
                            const VectorXd& natural_angles) {
  MotionModel model;
  model.noise = settings.noise;
  model.natural_spread = settings.noise.parameters > 0 ? settings.natural_spread : 0;
  model.velocity = settings.motion_model == MotionModelType::kVelocity;
  model.velocity_decay = settings.velocity_decay;
  model.velocity_noise = settings.velocity_noise;
  model.natural.resize(natural_angles.size());
  for (Eigen::Index j = 0; j < natural_angles.size(); ++j) {
    model.natural[j] = transform.Parameter(static_cast<int>(j), natural_angles[j]);
  }
  return model;
}

/// With the rates, where the motion model has them.
int NumStates(const S2kfSettings& settings, const MarkerKinematics& kinematics) {
  return (settings.motion_model == MotionModelType::kVelocity ? 2 : 1) * kinematics.num_dofs();
}

}  // namespace

MarkerFilter::MarkerFilter(const MarkerKinematics& kinematics, const S2kfSettings& settings,
                           const VectorXd& noise_scale)
    : kinematics_(kinematics),
      settings_(settings),
      noise_scale_(noise_scale),
      measurement_model_(
          kinematics, JointLimitTransform(settings.limits, kinematics.lower(), kinematics.upper()),
          settings.root, HalfSamples(settings, kinematics.num_dofs())),
      moments_(kinematics.num_dofs(), 3 * kinematics.num_markers()),
      update_(kinematics.num_dofs(), 3 * kinematics.num_markers()),
      llt_(NumStates(settings, kinematics)) {
  motion_model_ =
      MakeMotionModel(settings, measurement_model_.transform(), NaturalAngles(kinematics));
  const int n = kinematics.num_dofs();
  const int all = NumStates(settings, kinematics);
  z_.setZero(3 * kinematics.num_markers());
  expected_.setZero(3 * kinematics.num_markers());
  noise_.setZero(3 * kinematics.num_markers());
  L_.setZero(all, all);
  L_x_.setZero(n, n);
  spread_.setZero(n, n);
  U_.setZero(n, all);
  center_.setZero(n);
  dx_.setZero(all);
}

void MarkerFilter::StartAt(const Posture& posture, Belief* belief) const {
  // What a fit to markers that sit some centimetres off leaves open.
  constexpr double kPosition = 0.005;
  constexpr double kOrientation = 0.02;
  constexpr double kParameter = 0.05;
  constexpr double kVelocity = 0.5;
  constexpr double kRate = 1.0;
  const int n = kinematics_.num_dofs();
  belief->position = posture.position;
  belief->orientation = posture.orientation;
  belief->rpy = RpyFromRotation(posture.orientation.toRotationMatrix());
  belief->parameters.resize(n - 6);
  for (int j = 0; j < n - 6; ++j) {
    belief->parameters[j] = measurement_model_.transform().Parameter(j, posture.joint_angles[j]);
  }
  belief->P.resize(L_.rows(), L_.rows());
  belief->P.setZero();
  const auto set = [](auto&& diagonal, double position, double orientation, double parameter) {
    diagonal.template head<3>().setConstant(position * position);
    diagonal.template segment<3>(3).setConstant(orientation * orientation);
    diagonal.tail(diagonal.size() - 6).setConstant(parameter * parameter);
  };
  set(belief->P.diagonal().head(n), kPosition, kOrientation, kParameter);
  if (motion_model_.velocity) {
    belief->rate.setZero(n);
    set(belief->P.diagonal().tail(n), kVelocity, kRate, kRate);
  }
}

void MarkerFilter::StartAsPaper(const Ref<const Matrix3Xd>& z, Belief* belief) const {
  Posture posture;
  posture.joint_angles = measurement_model_.transform().middle();
  int seen = 0;
  for (Eigen::Index m = 0; m < z.cols(); ++m) {
    if (!z.col(m).allFinite()) continue;
    posture.position += z.col(m);
    ++seen;
  }
  posture.position /= seen;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (Eigen::Index m = 0; m < z.cols(); ++m) {
    if (!z.col(m).allFinite()) continue;
    const Vector3d d = z.col(m) - posture.position;
    spread += d * d.transpose() / (seen - 1);
  }
  StartAt(posture, belief);
  belief->P.topLeftCorner<3, 3>() = spread;
  belief->P.diagonal().segment<3>(3).setConstant(1e-6);
  belief->P.diagonal().segment(6, kinematics_.num_joints()).setConstant(1e-10);
}

void MarkerFilter::Predict(double dt, Belief* belief) const {
  motion_model_.Predict(dt, settings_.root, belief);
}

void MarkerFilter::Weigh(const Ref<const Matrix3Xd>& z, Outcome* outcome) {
  outcome->seen = 0;
  outcome->downweighted = 0;
  for (Eigen::Index m = 0; m < z.cols(); ++m) {
    const double distance = (z.col(m) - expected_.segment<3>(3 * m)).norm();
    if (!std::isfinite(distance)) {
      noise_.segment<3>(3 * m).setConstant(kInfinity);
      continue;
    }
    const double deviation = settings_.marker_deviation * noise_scale_[m];
    double variance = deviation * deviation;
    if (settings_.robust_distance > 0 && distance > settings_.robust_distance) {
      variance *= distance / settings_.robust_distance;
      ++outcome->downweighted;
    }
    noise_.segment<3>(3 * m).setConstant(variance);
    z_.segment<3>(3 * m) = z.col(m);
    ++outcome->seen;
  }
}

bool MarkerFilter::IsFarFromLinear() const {
  double unexplained = 0;
  double noise = 0;
  for (Eigen::Index i = 0; i < noise_.size(); ++i) {
    if (std::isinf(noise_[i])) continue;
    unexplained += moments_.residual[i];
    noise += noise_[i];
  }
  return unexplained > kLargestUnexplainedShare * noise;
}

void MarkerFilter::Relinearize(const Belief& belief) {
  // About N(mu, Sigma) of s, Sigma = root^T root: z = C_zt t + mean with t = root^-T (s - mu),
  // which is then the line z = H s + (mean - H mu) with H = C_zt root^-T (Garcia-Fernandez et al.
  // 2015).
  center_.noalias() = L_x_ * update_.mean();
  spread_.noalias() = L_x_ * update_.root().transpose();
  measurement_model_.ComputeMoments(belief, center_, spread_, false, &moments_);
  update_.root().transpose().triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(
      moments_.C_zs);
  moments_.mean.noalias() -= moments_.C_zs * update_.mean();
}

void MarkerFilter::Commit(Belief* belief) {
  const Eigen::Index n = L_x_.rows();
  const Eigen::Index all = L_.rows();
  dx_.noalias() = L_.leftCols(n) * update_.mean();
  Move(dx_.head(n), settings_.root, belief);
  if (motion_model_.velocity) belief->rate += dx_.tail(n);
  // P = L_left root^T root L_left^T + L_right L_right^T.
  U_.noalias() = update_.root() * L_.leftCols(n).transpose();
  belief->P.setZero();
  auto P = belief->P.selfadjointView<Eigen::Lower>();
  P.rankUpdate(U_.transpose());
  if (all > n) P.rankUpdate(L_.rightCols(all - n));
  belief->P.triangularView<Eigen::StrictlyUpper>() = belief->P.transpose();
  measurement_model_.transform().Fold(6, belief->parameters, &belief->P);
}

MarkerFilter::Outcome MarkerFilter::Update(const Ref<const Matrix3Xd>& z, Belief* belief) {
  const Eigen::Index n = L_x_.rows();
  const bool exact = settings_.update == UpdateForm::kExact;
  llt_.compute(belief->P);
  L_ = llt_.matrixL();
  L_x_ = L_.topLeftCorner(n, n);
  center_.setZero();
  measurement_model_.ComputeMoments(*belief, center_, L_x_, exact, &moments_);
  expected_ = moments_.mean;
  Outcome outcome;
  Weigh(z, &outcome);
  if (outcome.seen == 0) return outcome;
  update_.Compute(moments_, z_, noise_, settings_.update);
  outcome.nis = update_.nis() / (3 * outcome.seen);
  for (int i = 1; i < settings_.iterations; ++i) {
    const bool is_far = IsFarFromLinear();
    if (!is_far && outcome.downweighted == 0) break;
    if (is_far) Relinearize(*belief);
    // A marker that is far from where it was expected is wrong only if it is far from the estimate.
    expected_ = moments_.mean;
    expected_.noalias() += moments_.C_zs * update_.mean();
    Weigh(z, &outcome);
    update_.Compute(moments_, z_, noise_, settings_.update);
  }
  Commit(belief);
  return outcome;
}

void MarkerFilter::ToPosture(const Belief& belief, Posture* posture) const {
  posture->position = belief.position;
  posture->orientation = belief.orientation;
  posture->joint_angles.resize(belief.parameters.size());
  for (int j = 0; j < kinematics_.num_joints(); ++j) {
    posture->joint_angles[j] = measurement_model_.transform().Angle(j, belief.parameters[j]);
  }
}

void MarkerFilter::Deviations(const Belief& belief, VectorXd* deviations) const {
  const Eigen::Index n = belief.num_states();
  *deviations = belief.P.diagonal().head(n).cwiseSqrt();
  for (int j = 0; j < kinematics_.num_joints(); ++j) {
    (*deviations)[6 + j] = measurement_model_.transform().AngleDeviation(j, belief.parameters[j],
                                                                         (*deviations)[6 + j]);
  }
}

}  // namespace mmm_converter::s2kf
