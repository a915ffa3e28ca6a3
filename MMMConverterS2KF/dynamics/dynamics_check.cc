// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/dynamics/dynamics_check.h"

#include <utility>

namespace mmm_converter {

DynamicsReport CheckDynamics(const InputRequest& request, const DynamicsOptions& options) {
  CheckedMotion motion = ReadCheckedMotion(request);
  DynamicsOptions of_frames = options;
  of_frames.first_frame = motion.begin;
  of_frames.end_frame = motion.end;
  MotionDynamics dynamics = ComputeMotionDynamics(motion.model, motion.trajectory, of_frames);
  Plausibility judged = JudgeDynamics(motion.model, dynamics);
  return {std::move(motion), std::move(dynamics), std::move(judged)};
}

}  // namespace mmm_converter
