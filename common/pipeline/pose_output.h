// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/io/tables/pose_table.h"
#include "common/model/kinematic_model.h"
#include "common/motion/body_poses.h"

namespace mmm_converter {

/// What of a body's poses is written.
struct PoseChoice {
  std::vector<std::string> segments = {"all"};  ///< names of the model; or "all" or "none" alone
  std::string points = "kit21";                 ///< see PointSets
  bool relative_to_root = false;
  RotationForm rotation = RotationForm::kQuaternion;
};

/// Of "kit21" (KitPoints), "kit44" (KitJointPoints; of a model without these joints both are
/// nothing), "all" (JointPoints) and "none".
const std::vector<std::string>& PointSets();

/// The segments and points of a model; no objects.
/// @throws Error naming the segments that the model does not have.
BodySelection SelectBodies(const KinematicModel& model, const PoseChoice& choice);

/// The motions without joints that an MMM file has beside `motion`; none of another file.
std::vector<ObjectMotion> ObjectsBeside(const std::string& file, const std::string& motion);

}  // namespace mmm_converter
