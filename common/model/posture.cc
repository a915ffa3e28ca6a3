// SPDX-License-Identifier: MIT
#include "common/model/posture.h"

#include <algorithm>
#include <cassert>

#include "common/math/rotation.h"
#include "common/model/kinematic_model.h"

namespace mmm_converter {

Posture ZeroPosture(const KinematicModel& model) {
  Posture posture;
  posture.orientation = model.standing();
  if (model.is_root_fixed()) {
    const Eigen::Isometry3d& X_WS = model.segments().front().X_PF;
    posture.position = X_WS.translation();
    posture.orientation = Eigen::Quaterniond(X_WS.linear());
  }
  posture.joint_angles.resize(model.num_joints());
  for (int i = 0; i < model.num_joints(); ++i) {
    const Segment& joint = model.joint(i);
    posture.joint_angles[i] = std::clamp(joint.rest, joint.lower, joint.upper);
  }
  return posture;
}

Eigen::VectorXd RestAngles(const KinematicModel& model) {
  Eigen::VectorXd angles(model.num_joints());
  for (int i = 0; i < model.num_joints(); ++i) angles[i] = model.joint(i).rest;
  return angles;
}

Posture Retract(const Posture& q, const Eigen::Ref<const Eigen::VectorXd>& dq) {
  assert(dq.size() == 6 + q.joint_angles.size());
  Posture moved;
  moved.position = q.position + dq.head<3>();
  moved.orientation = (q.orientation * Exp(dq.segment<3>(3))).normalized();
  moved.joint_angles = q.joint_angles + dq.tail(q.joint_angles.size());
  return moved;
}

Eigen::VectorXd Local(const Posture& q0, const Posture& q1) {
  assert(q0.joint_angles.size() == q1.joint_angles.size());
  Eigen::VectorXd dq(6 + q0.joint_angles.size());
  dq << q1.position - q0.position, Log(q0.orientation.conjugate() * q1.orientation),
      q1.joint_angles - q0.joint_angles;
  return dq;
}

}  // namespace mmm_converter
