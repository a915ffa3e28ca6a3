// SPDX-License-Identifier: MIT
#include "plugins/jacobian/jacobian_converter.h"

#include <cmath>
#include <string>

#include "common/model/posture.h"
#include "common/support/error.h"
#include "common/support/units.h"

namespace mmm_converter::jacobian {

using Eigen::Matrix3Xd;
using Eigen::Ref;

namespace {

// Steps have converged where the last one asked for less than this [rad].
constexpr double kSmallStep = 1e-3;

}  // namespace

JacobianConverter::JacobianConverter(const TrackingSetup& setup, const JacobianSettings& settings)
    : MotionConverter(setup),
      settings_(settings),
      kinematics_(*setup.model, setup.joints, MarkerIndices(setup.assignments())),
      labels_(LabelIndices(setup.assignments())),
      noise_scale_(NoiseScales(setup.assignments())),
      search_(kinematics_),
      steps_(kinematics_),
      at_(kinematics_.MakeJacobian()),
      z_(3, kinematics_.num_markers()) {
  fit_options_.max_iterations = settings.max_iterations;
  fit_options_.tolerance = settings.tolerance;
  fit_options_.natural_weight = settings.natural_weight;
  fit_options_.start_weight = settings.previous_weight;
  if (settings.robust_distance > 0) fit_options_.robust_distance = settings.robust_distance;
  fit_options_.pulls = PullsOf(setup);
  step_options_ = {settings.damping, settings.step_limit, fit_options_};
  posture_.joint_angles.setZero(kinematics_.num_joints());
  estimate_.posture.joint_angles = RestAngles(*setup.model);
  estimate_.standard_deviations.setConstant(6 + setup.model->num_joints(), kNaN);
  estimate_.residuals.setConstant(kinematics_.num_markers(), kNaN);
}

void JacobianConverter::Gather(const Ref<const Matrix3Xd>& frame) {
  estimate_.markers_seen = 0;
  for (std::size_t i = 0; i < labels_.size(); ++i) {
    z_.col(i) = frame.col(labels_[i]);
    if (IsSeen(z_.col(i))) {
      ++estimate_.markers_seen;
    } else {
      z_.col(i).setConstant(kNaN);
    }
  }
}

const FrameEstimate& JacobianConverter::Assemble(const Ref<const Matrix3Xd>& frame) {
  Gather(frame);
  if (estimate_.markers_seen < kFewestMarkers) {
    throw Error("only " + std::to_string(estimate_.markers_seen) +
                " of the mapped markers are seen in the first frame; at least 3 are needed");
  }
  PostureFitOptions options = fit_options_;
  options.start_weight = 0;
  const PostureFit::Result result =
      search_.Assemble(z_, noise_scale_, options, settings_.start_attempts, &posture_);
  FillEstimate(result.converged);
  return estimate_;
}

bool JacobianConverter::TakeSteps() {
  double asked = 0;
  for (int i = 0; i < settings_.steps; ++i) {
    asked = steps_.Step(z_, noise_scale_, step_options_, &posture_);
  }
  return asked < kSmallStep;
}

const FrameEstimate& JacobianConverter::Track(const Ref<const Matrix3Xd>& frame, double /*dt*/) {
  Gather(frame);
  bool converged = false;
  if (estimate_.markers_seen > 0) {
    converged = settings_.method == Method::kGradient
                    ? TakeSteps()
                    : search_.fit().Solve(z_, noise_scale_, fit_options_, &posture_).converged;
  }
  FillEstimate(converged && estimate_.markers_seen >= kFewestMarkers);
  return estimate_;
}

void JacobianConverter::FillEstimate(bool converged) {
  estimate_.converged = converged;
  estimate_.posture.position = posture_.position;
  estimate_.posture.orientation = posture_.orientation;
  for (int j = 0; j < kinematics_.num_joints(); ++j) {
    estimate_.posture.joint_angles[kinematics_.joints()[j]] = posture_.joint_angles[j];
  }
  kinematics_.ComputeMarkers(posture_.position, posture_.orientation.toRotationMatrix(),
                             posture_.joint_angles, &at_);
  estimate_.markers_downweighted = 0;
  for (int m = 0; m < kinematics_.num_markers(); ++m) {
    const double distance = (z_.col(m) - at_.p_WM.col(m)).norm();
    estimate_.residuals[m] = distance;
    estimate_.markers_downweighted += distance > fit_options_.robust_distance ? 1 : 0;
  }
}

}  // namespace mmm_converter::jacobian
