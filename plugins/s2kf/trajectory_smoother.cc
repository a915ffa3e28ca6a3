// SPDX-License-Identifier: MIT
#include "plugins/s2kf/trajectory_smoother.h"

#include <cmath>

#include "common/math/dense.h"

namespace mmm_converter::s2kf {

namespace {

// How far a smoothed parameter is followed from the filter's, where the sine is no longer straight
// [rad].
constexpr double kLinear = 1;

}  // namespace

TrajectorySmoother::TrajectorySmoother(const MotionModel& motion_model,
                                       const JointLimitTransform& transform, RootParameters root,
                                       int num_states)
    : motion_model_(motion_model), transform_(transform), root_(root), n_(num_states) {
  const int all = (motion_model.velocity ? 2 : 1) * num_states;
  for (PaddedMatrix* matrix : {&P_, &L_inverse_, &A_, &S_, &AS_, &result_}) {
    *matrix = PaddedMatrix(all, all);
  }
}

void TrajectorySmoother::StepBack(const Belief& filtered, double dt) {
  step_ = motion_model_.StepOf(dt);
  F_inverse_ = step_.F.Inverse(motion_model_.velocity);
  folded_ = filtered;
  Fold(transform_, &folded_);
  predicted_ = folded_;
  motion_model_.Predict(dt, root_, &predicted_);
  ComputeGain();
  S_.view() = smoothed_.P;
  SmoothMean();
  SmoothCovariance();
  Unfold(filtered);
}

void TrajectorySmoother::ComputeGain() {
  P_.SetZero();
  P_.view() = predicted_.P;
  Factorize(&P_);
  L_inverse_.SetIdentity();
  DivideByTransposed(P_, &L_inverse_);
  P_.SetZero();
  AddSquare(1, L_inverse_, &P_);
  auto inverse = P_.view();
  inverse.triangularView<Eigen::StrictlyUpper>() = inverse.transpose();
  auto A = A_.view();
  for (int i = 0; i < n_; ++i) {
    const Eigen::Matrix2d& Q = step_.Q.Of(i);
    A.row(i) = -Q(0, 0) * inverse.row(i);
    if (!motion_model_.velocity) continue;
    A.row(i) -= Q(0, 1) * inverse.row(n_ + i);
    A.row(n_ + i) = -Q(1, 0) * inverse.row(i) - Q(1, 1) * inverse.row(n_ + i);
  }
  A.diagonal().array() += 1;
}

void TrajectorySmoother::SmoothMean() {
  Difference(predicted_, smoothed_, root_, &difference_);
  dx_.noalias() = A_.view() * difference_;
  F_inverse_.Apply(n_, &dx_);
  smoothed_ = folded_;
  Move(dx_.head(n_), root_, &smoothed_);
  if (motion_model_.velocity) smoothed_.rate += dx_.tail(n_);
}

void TrajectorySmoother::SmoothCovariance() {
  Multiply(1, A_, S_, &AS_);
  MultiplyByTransposed(AS_, A_, &result_);
  Eigen::MatrixXd& P = smoothed_.P;
  P = result_.view();
  const auto A = A_.view();
  for (int i = 0; i < n_; ++i) {
    const Eigen::Matrix2d& Q = step_.Q.Of(i);
    P.col(i) += Q(0, 0) * A.col(i);
    if (!motion_model_.velocity) continue;
    P.col(i) += Q(1, 0) * A.col(n_ + i);
    P.col(n_ + i) += Q(0, 1) * A.col(i) + Q(1, 1) * A.col(n_ + i);
  }
  F_inverse_.Apply(n_, &P);
  P.triangularView<Eigen::StrictlyUpper>() = P.transpose();
}

void TrajectorySmoother::Unfold(const Belief& filtered) {
  for (int j = 0; j < filtered.parameters.size(); ++j) {
    const double before = filtered.parameters[j];
    double after = before;
    const bool mirrored = transform_.Fold(j, &after);
    double& smoothed = smoothed_.parameters[j];
    if (mirrored) {
      smoothed = before + after - smoothed;
      Mirror(j, &smoothed_);
    } else {
      smoothed += before - after;
    }
  }
}

void TrajectorySmoother::EstimateAbout(const Belief& filtered, Belief* estimate) const {
  *estimate = smoothed_;
  for (int j = 0; j < filtered.parameters.size(); ++j) {
    const double from = filtered.parameters[j];
    const double step = smoothed_.parameters[j] - from;
    estimate->parameters[j] = from + kLinear * std::tanh(step / kLinear);
  }
}

}  // namespace mmm_converter::s2kf
