// SPDX-License-Identifier: MIT
#include "plugins/s2kf/marker_filter.h"

#include <cmath>
#include <limits>
#include <utility>

#include "common/fit/posture_fit.h"
#include "common/math/dense.h"
#include "common/math/rotation.h"
#include "common/support/units.h"
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

// Of what does not move, each coordinate [m, rad]: as good as 0, and no pivot is.
constexpr double kFixed = 1e-9;

MotionModel MakeMotionModel(const S2kfSettings& settings, const JointLimitTransform& transform,
                            const MarkerKinematics& kinematics) {
  MotionModel model;
  model.velocity = settings.motion_model == MotionModelType::kVelocity;
  model.noise = (model.velocity ? settings.velocity_noise : settings.noise)
                    .Scaled(settings.process_noise_scale);
  if (kinematics.is_root_fixed()) model.noise.position = model.noise.orientation = 0;
  model.natural_spread = settings.natural_spread;
  model.velocity_decay = settings.velocity_decay;
  model.natural = NaturalAngles(kinematics);
  for (int j = 0; j < kinematics.num_joints(); ++j) {
    model.natural[j] = kinematics.IsEndless(j) ? kNaN : transform.Parameter(j, model.natural[j]);
  }
  return model;
}

/// With the rates, where the motion model has them.
int NumStates(const S2kfSettings& settings, const MarkerKinematics& kinematics) {
  return (settings.motion_model == MotionModelType::kVelocity ? 2 : 1) * kinematics.num_dofs();
}

}  // namespace

MarkerFilter::MarkerFilter(const MarkerKinematics& kinematics, const S2kfSettings& settings,
                           const VectorXd& noise_scale, std::vector<JointPull> pulls)
    : kinematics_(kinematics),
      settings_(settings),
      noise_scale_(noise_scale),
      pulls_(std::move(pulls)),
      measurement_model_(kinematics, JointLimitTransform(settings.limits, kinematics),
                         settings.root, HalfSamples(settings, kinematics.num_dofs())),
      C_sz_(kinematics.num_dofs(), 3 * kinematics.num_markers()),
      prior_moments_(kinematics.num_dofs(), 3 * kinematics.num_markers()) {
  motion_model_ = MakeMotionModel(settings, measurement_model_.transform(), kinematics);
  resting_ = kinematics.RestingJoints();
  const int n = kinematics.num_dofs();
  const int all = NumStates(settings, kinematics);
  z_.setZero(3 * kinematics.num_markers());
  expected_.setZero(3 * kinematics.num_markers());
  noise_.setZero(3 * kinematics.num_markers());
  L_ = PaddedMatrix(all, n);
  if (all > n) {
    L_rates_ = PaddedMatrix(all, n);
    L_states_ = PaddedMatrix(n, n);
  }
  P_ = PaddedMatrix(all, all);
  posterior_ = PaddedMatrix(all, n);
  posterior_x_ = PaddedMatrix(n, n);
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
  belief->P.resize(P_.rows(), P_.rows());
  belief->P.setZero();
  const bool is_fixed = kinematics_.is_root_fixed();
  const auto set = [&](auto&& diagonal, double position, double orientation, double parameter) {
    diagonal.template head<3>().setConstant(position * position);
    diagonal.template segment<3>(3).setConstant(orientation * orientation);
    if (is_fixed) diagonal.template head<6>().setConstant(kFixed * kFixed);
    diagonal.tail(diagonal.size() - 6).setConstant(parameter * parameter);
  };
  set(belief->P.diagonal().head(n), kPosition, kOrientation, kParameter);
  if (motion_model_.velocity) {
    belief->rate.setZero(n);
    set(belief->P.diagonal().tail(n), kVelocity, kRate, kRate);
  }
  Rest(belief);
}

/// Joints that move no marker are where they rest, whatever samples of others make of them.
void MarkerFilter::Rest(Belief* belief) const {
  const Eigen::Index n = belief->num_states();
  for (const int j : resting_) {
    belief->parameters[j] = motion_model_.natural[j];
    for (Eigen::Index i = 6 + j; i < belief->P.rows(); i += n) {
      belief->P.row(i).setZero();
      belief->P.col(i).setZero();
      belief->P(i, i) = kFixed * kFixed;
      if (i >= n) belief->rate[i - n] = 0;
    }
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
  if (kinematics_.is_root_fixed()) {
    posture.position = kinematics_.X_WS().translation();
    posture.orientation = Eigen::Quaterniond(kinematics_.X_WS().linear());
  }
  StartAt(posture, belief);
  if (!kinematics_.is_root_fixed()) {
    belief->P.topLeftCorner<3, 3>() = spread;
    belief->P.diagonal().segment<3>(3).setConstant(1e-6);
  }
  belief->P.diagonal().segment(6, kinematics_.num_joints()).setConstant(1e-10);
  Rest(belief);
}

void MarkerFilter::Predict(double dt, Belief* belief) {
  Fold(measurement_model_.transform(), belief);
  motion_model_.Predict(dt, settings_.root, belief);
  Rest(belief);
  for (const JointPull& pull : pulls_) Pull(pull, belief);
}

/// The pull weighs against all markers as it does in a fit: the joint is measured at its value,
/// theta + v, v ~ N(0, s^2 / (weight sum(1 / s_m^2))), s the deviation of a marker of s_m = 1.
void MarkerFilter::Pull(const JointPull& pull, Belief* belief) {
  const JointLimitTransform& transform = measurement_model_.transform();
  const double parameter = belief->parameters[pull.joint];
  const double slope = transform.Slope(pull.joint, parameter);
  const double off = pull.value - transform.Angle(pull.joint, parameter);
  const double marker = settings_.marker_deviation * settings_.marker_deviation;
  const double noise = marker / (pull.weight * noise_scale_.cwiseAbs2().cwiseInverse().sum());
  const Eigen::Index i = 6 + pull.joint;
  const Eigen::Index n = L_.cols();
  auto column = belief->P.col(i);
  const double spread = slope * slope * column[i] + noise;
  dx_ = (slope * off / spread) * column;
  const double share = slope * slope / spread;
  for (Eigen::Index k = 0; k < belief->P.cols(); ++k) {
    if (k != i) belief->P.col(k) -= share * column[k] * column;
  }
  column *= noise / spread;
  Move(dx_.head(n), settings_.root, belief);
  if (motion_model_.velocity) belief->rate += dx_.tail(n);
}

void MarkerFilter::Weigh(const Ref<const Matrix3Xd>& z, UpdateOutcome* outcome) {
  outcome->seen = 0;
  outcome->downweighted = 0;
  for (Eigen::Index m = 0; m < z.cols(); ++m) {
    const double deviation = settings_.marker_deviation * noise_scale_[m];
    double& variance = outcome->variance[m];
    variance = deviation * deviation;
    const double distance = (z.col(m) - expected_.segment<3>(3 * m)).norm();
    if (!std::isfinite(distance)) {
      noise_.segment<3>(3 * m).setConstant(kInfinity);
      continue;
    }
    if (settings_.robust_distance > 0 && distance > settings_.robust_distance) {
      variance *= distance / settings_.robust_distance;
      ++outcome->downweighted;
    }
    noise_.segment<3>(3 * m).setConstant(variance);
    z_.segment<3>(3 * m) = z.col(m);
    ++outcome->seen;
  }
}

bool MarkerFilter::IsFarFromLinear(const MeasurementMoments& moments) const {
  double unexplained = 0;
  double noise = 0;
  for (Eigen::Index i = 0; i < noise_.size(); ++i) {
    if (std::isinf(noise_[i])) continue;
    unexplained += moments.residual[i];
    noise += noise_[i];
  }
  return unexplained > kLargestUnexplainedShare * noise;
}

void MarkerFilter::Relinearize(const Belief& belief, UpdateOutcome* outcome) {
  // About N(mu, T T^T) of s: z = C_zt t + mean with t = T^-1 (s - mu), which is then the line
  // z = H s + (mean - H mu) with H = C_zt T^-1 (Garcia-Fernandez et al. 2015).
  const GaussianUpdate& update = outcome->update;
  MeasurementMoments& moments = outcome->moments;
  center_.noalias() = L_x().view() * update.mean();
  update.Spread(L_x(), &posterior_x_);
  measurement_model_.ComputeMoments(belief, center_, {posterior_x_}, false, &moments);
  update.FromPosteriorSpace(&moments.C_sz, &C_sz_);
  moments.mean -= moments.C_sz.view().transpose().lazyProduct(update.mean());
}

void MarkerFilter::Commit(const GaussianUpdate& update, Belief* belief) {
  const Eigen::Index n = L_.cols();
  const Eigen::Index all = L_.rows();
  dx_.noalias() = L_.view() * update.mean();
  Move(dx_.head(n), settings_.root, belief);
  if (motion_model_.velocity) belief->rate += dx_.tail(n);
  // What the markers said of L_'s part of the state leaves the rest as it was.
  update.Spread(L_, &posterior_);
  P_.SetZero();
  AddSquare(1, posterior_, &P_);
  if (all > n) AddSquare(1, L_rates_, &P_);
  belief->P.triangularView<Eigen::Lower>() = P_.view();
  belief->P.triangularView<Eigen::StrictlyUpper>() = belief->P.transpose();
}

void MarkerFilter::FactorizeCovariance(const Belief& belief) {
  const Eigen::Index n = L_.cols();
  P_.SetZero();
  P_.view() = belief.P;
  Factorize(&P_);
  L_.view() = P_.view().leftCols(n);
  if (L_.rows() > n) {
    L_rates_.view() = P_.view().rightCols(n);
    L_states_.view() = P_.view().topLeftCorner(n, n);
  }
}

void MarkerFilter::Expect(const Belief& belief, MeasurementMoments* moments) {
  FactorizeCovariance(belief);
  center_.setZero();
  measurement_model_.ComputeMoments(belief, center_, {L_x(), true},
                                    settings_.update == UpdateForm::kExact, moments);
}

void MarkerFilter::Prepare(const Belief& prior) {
  Expect(prior, &prior_moments_);
  prior_ = prior;
  is_prepared_ = true;
}

void MarkerFilter::Update(const Ref<const Matrix3Xd>& z, Belief* belief, UpdateOutcome* outcome) {
  MeasurementMoments& moments = outcome->moments;
  GaussianUpdate& update = outcome->update;
  is_prepared_ = is_prepared_ && *belief == prior_;
  if (is_prepared_) {
    moments = prior_moments_;
  } else {
    Expect(*belief, &moments);
  }
  expected_ = moments.mean;
  Weigh(z, outcome);
  update.Compute(moments, z_, noise_, settings_.update);
  outcome->nis = outcome->seen > 0 ? update.nis() / (3 * outcome->seen) : 0;
  outcome->log_likelihood = update.log_likelihood();
  if (outcome->seen == 0) return;
  for (int i = 1; i < settings_.iterations; ++i) {
    const bool is_far = IsFarFromLinear(moments);
    if (!is_far && outcome->downweighted == 0) break;
    if (is_far) Relinearize(*belief, outcome);
    // A marker that is far from where it was expected is wrong only if it is far from the estimate.
    expected_ = moments.mean;
    expected_ += moments.C_sz.view().transpose().lazyProduct(update.mean());
    Weigh(z, outcome);
    update.Compute(moments, z_, noise_, settings_.update);
  }
  Commit(update, belief);
}

void MarkerFilter::ToPosture(const Belief& belief, Posture* posture) const {
  posture->position = belief.position;
  posture->orientation = belief.orientation;
  posture->joint_angles.resize(belief.parameters.size());
  for (int j = 0; j < kinematics_.num_joints(); ++j) {
    posture->joint_angles[j] = measurement_model_.transform().Angle(j, belief.parameters[j]);
  }
}

void MarkerFilter::Place(const Belief& belief, Posture* posture, MarkerJacobian* at) const {
  ToPosture(belief, posture);
  kinematics_.ComputeMarkers(posture->position, posture->orientation.toRotationMatrix(),
                             posture->joint_angles, at);
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
