// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/dynamics/dynamics_check.h"

#include <utility>

namespace mmm_converter {

DynamicsReport CheckDynamics(const InputRequest& request, const DynamicsOptions& options) {
  CheckedMotion motion = ReadCheckedMotion(request);
  MotionDynamics dynamics = ComputeMotionDynamics(motion.model, motion.trajectory, options);
  Plausibility judged = JudgeDynamics(motion.model, dynamics);
  return {std::move(motion), std::move(dynamics), std::move(judged)};
}

}  // namespace mmm_converter
