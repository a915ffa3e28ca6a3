// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/convert/motion_converter.h"
#include "common/fit/posture_search.h"
#include "common/model/marker_kinematics.h"
#include "plugins/jacobian/damped_steps.h"
#include "plugins/jacobian/jacobian_settings.h"

namespace mmm_converter::jacobian {

/// Fits each frame on its own, from the posture of the previous one. What no marker determines
/// stays as it was, apart from a weak pull to the natural posture; where nothing is seen, the whole
/// posture stays. Knows no uncertainty: standard deviations are NaN.
class JacobianConverter : public MotionConverter {
 public:
  JacobianConverter(const TrackingSetup& setup, const JacobianSettings& settings);

  const FrameEstimate& Assemble(const Eigen::Ref<const Eigen::Matrix3Xd>& frame) override;
  const FrameEstimate& Track(const Eigen::Ref<const Eigen::Matrix3Xd>& frame, double dt) override;

 private:
  /// Takes the assigned markers out of a frame into z_.
  void Gather(const Eigen::Ref<const Eigen::Matrix3Xd>& frame);
  bool TakeSteps();
  void FillEstimate(bool converged);

  JacobianSettings settings_;
  MarkerKinematics kinematics_;
  std::vector<LabelIx> labels_;  // by assignment
  Eigen::VectorXd noise_scale_;
  PostureSearch search_;
  PostureFitOptions fit_options_;
  DampedSteps steps_;
  DampedStepOptions step_options_;
  MarkerJacobian at_;

  Eigen::Matrix3Xd z_;
  Posture posture_;  // tracked joints
  FrameEstimate estimate_;
};

}  // namespace mmm_converter::jacobian
