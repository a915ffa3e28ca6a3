// SPDX-License-Identifier: MIT
#include "common/pipeline/dynamics/dynamics_check.h"

#include <utility>

#include "common/contacts/contacts.h"
#include "common/forces/recording_forces.h"
#include "common/io/bytes/file_content.h"
#include "common/io/mjcf/mjcf_robot.h"
#include "common/io/robot/robot_file.h"
#include "common/io/urdf/urdf_model_reader.h"
#include "common/math/up_axis.h"
#include "common/support/error.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

/// With what was measured of the ground, in the axes in which it is exported beside a motion; of
/// the frames that are checked.
JointForces WithForces(const CheckedMotion& motion, const Contacts& feet,
                       const RecordedForces& forces, double cutoff) {
  JointForces found = ComputeJointForces(motion.model, motion.trajectory, feet, forces, {cutoff});
  for (Eigen::MatrixXd* one : {&found.forces, &found.residuals}) {
    one->leftCols(motion.begin).setConstant(kNaN);
    one->rightCols(found.num_frames() - motion.end).setConstant(kNaN);
  }
  return found;
}

/// Empty: the model is no robot's.
Eigen::VectorXd EffortLimits(const CheckedMotion& motion) {
  constexpr std::size_t kStart = 1 << 16;
  if (motion.model_file.empty()) return {};
  const std::string start = ReadFileStart(motion.model_file, kStart);
  if (!IsUrdf(start) && !IsMjcf(start)) return {};
  const Robot robot = ReadRobotFile(motion.model_file);
  return robot.model.num_joints() == motion.model.num_joints() ? robot.effort_limits
                                                               : Eigen::VectorXd();
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
  std::optional<RecordedForces> forces;
  if (!motion.forces_file.empty()) {
    forces = ForcesOf(motion.forces_file, UpAxis::kY, &motion.warnings);
  }
  Contacts feet;  // none: the model has no feet that are known
  ContactFinder by_plates;
  if (forces) {
    by_plates = [&](const FootMotion& moved) {
      feet = FindContacts(moved, *forces);
      return static_cast<const FootContacts&>(feet);
    };
  }
  MotionDynamics dynamics =
      ComputeMotionDynamics(motion.model, motion.trajectory, of_frames, progress, by_plates);
  std::optional<JointForces> with_forces;
  if (forces) with_forces = WithForces(motion, feet, *forces, options.cutoff);
  Plausibility judged = JudgeDynamics(motion.model, dynamics, EffortLimits(motion));
  return {std::move(motion), std::move(dynamics), std::move(judged), std::move(with_forces)};
}

}  // namespace mmm_converter
