// SPDX-License-Identifier: MIT
#pragma once

#include "common/math/seeded_random.h"
#include "common/model/kinematic_model.h"
#include "common/model/posture.h"

namespace mmm_converter::testing {

/// Every joint uniform within its limits, any heading and orientation, within 2 m of the origin.
inline Posture RandomPosture(const KinematicModel& model, SeededRandom& random) {
  Posture posture;
  for (int i = 0; i < 3; ++i) posture.position[i] = 4 * random.Uniform() - 2;
  for (int i = 0; i < 4; ++i) posture.orientation.coeffs()[i] = random.Normal();
  posture.orientation.normalize();
  posture.joint_angles.resize(model.num_joints());
  for (int i = 0; i < model.num_joints(); ++i) {
    const Segment& joint = model.joint(i);
    const double lower = IsEndless(joint) ? -10 : joint.lower;
    const double upper = IsEndless(joint) ? 10 : joint.upper;
    posture.joint_angles[i] = lower + (upper - lower) * random.Uniform();
  }
  return posture;
}

}  // namespace mmm_converter::testing
