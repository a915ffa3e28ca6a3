// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/dynamics/dynamics_check.h"

#include <utility>

#include "common/support/error.h"

namespace mmm_converter {

#ifdef MMM_CONVERTER_HAS_DYNAMICS

DynamicsReport CheckDynamics(CheckedMotion motion, const DynamicsOptions& options,
                             const std::function<void(int, int)>& progress) {
  DynamicsOptions of_frames = options;
  of_frames.first_frame = motion.begin;
  of_frames.end_frame = motion.end;
  MotionDynamics dynamics =
      ComputeMotionDynamics(motion.model, motion.trajectory, of_frames, progress);
  Plausibility judged = JudgeDynamics(motion.model, dynamics);
  return {std::move(motion), std::move(dynamics), std::move(judged)};
}

#else

DynamicsReport CheckDynamics(CheckedMotion, const DynamicsOptions&,
                             const std::function<void(int, int)>&) {
  throw Error(
      "check-dynamics: this program was built without Simbody, which computes the forces; install "
      "it (Debian: libsimbody-dev) and build again, without -DMMM_CONVERTER_DYNAMICS=OFF");
}

#endif

}  // namespace mmm_converter
