// SPDX-License-Identifier: MIT
#include "common/pipeline/dynamics/dynamics_check.h"

#include <utility>

#include "common/support/error.h"

namespace mmm_converter {

DynamicsReport CheckDynamics(CheckedMotion motion, const DynamicsOptions& options,
                             const std::function<void(int, int)>& progress) {
  if (motion.model.coordinates()) {
    throw Error(motion.model_file +
                ": physics can't be computed of a model of OpenSim, whose joints are functions of "
                "coordinates");
  }
  DynamicsOptions of_frames = options;
  of_frames.first_frame = motion.begin;
  of_frames.end_frame = motion.end;
  MotionDynamics dynamics =
      ComputeMotionDynamics(motion.model, motion.trajectory, of_frames, progress);
  Plausibility judged = JudgeDynamics(motion.model, dynamics);
  return {std::move(motion), std::move(dynamics), std::move(judged)};
}

}  // namespace mmm_converter
