// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/model/kinematic_model.h"

namespace mmm_converter {

/// The origin of a segment, under a name of its own.
struct ModelPoint {
  std::string name;
  int segment = 0;
};

/// The 21 points of a body in the order that users of the KIT Motion-Language data set have them
/// (language2pose; HumanML3D's KIT-ML): root, BP, BT, BLN, BUN, LS, LE, LW, RS, RE, RW, LH, LK, LA,
/// LMrot, LF, RH, RK, RA, RMrot, RF, each where the MMM model's joint of that name turns. Empty:
/// the model has not all of these joints.
std::vector<ModelPoint> KitPoints(const KinematicModel& model);

/// For each of the 44 joint angles of that data set, in its order (KitJointNames), the place where
/// the joint turns; joints about several axes of one place repeat it. Empty: as above.
std::vector<ModelPoint> KitJointPoints(const KinematicModel& model);

/// The origins of the root and of all segments with a joint that moves, under the segments' names.
std::vector<ModelPoint> JointPoints(const KinematicModel& model);

}  // namespace mmm_converter
