// SPDX-License-Identifier: MIT
#include "common/pipeline/dynamics/dynamics_check.h"

#include <utility>

#include "common/contacts/foot_motion.h"
#include "common/forces/recording_forces.h"
#include "common/math/up_axis.h"
#include "common/support/error.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

/// With what was measured of the ground, in the axes in which it is exported beside a motion; of
/// the frames that are checked.
std::optional<JointForces> MeasuredForces(CheckedMotion* motion, const DynamicsOptions& options) {
  if (motion->forces_file.empty()) return std::nullopt;
  const RecordedForces forces = ForcesOf(motion->forces_file, UpAxis::kY, &motion->warnings);
  const Contacts contacts = FindContacts(MoveFeet(motion->model, motion->trajectory), forces);
  JointForces found =
      ComputeJointForces(motion->model, motion->trajectory, contacts, forces, {options.cutoff});
  for (Eigen::MatrixXd* one : {&found.forces, &found.residuals}) {
    one->leftCols(motion->begin).setConstant(kNaN);
    one->rightCols(found.num_frames() - motion->end).setConstant(kNaN);
  }
  return found;
}

}  // namespace

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
  std::optional<JointForces> with_forces = MeasuredForces(&motion, options);
  MotionDynamics dynamics =
      ComputeMotionDynamics(motion.model, motion.trajectory, of_frames, progress);
  Plausibility judged = JudgeDynamics(motion.model, dynamics);
  return {std::move(motion), std::move(dynamics), std::move(judged), std::move(with_forces)};
}

}  // namespace mmm_converter
