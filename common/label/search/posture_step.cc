// SPDX-License-Identifier: MIT
#include "common/label/search/posture_step.h"

#include "common/label/tuning.h"
#include "common/math/rotation.h"

namespace mmm_converter {

using Eigen::VectorXd;

void StepTowards(const Eigen::Ref<const Eigen::Matrix3Xd>& targets, const VectorXd& noise,
                 double robust_distance, const LabelBody& body, NormalEquations* equations,
                 Posture* posture) {
  const int joints = body.kinematics.num_joints();
  equations->Linearize(targets, noise, robust_distance);
  equations->H().diagonal().tail(joints).array() += MatchCosts::kNaturalWeight;
  equations->g().tail(joints) +=
      MatchCosts::kNaturalWeight * (body.natural_angles - posture->joint_angles);
  StepInsideLimits(StepTuning::kDamping, StepTuning::kLeastCurvature, StepTuning::kLongest, body,
                   equations, posture);
}

void StepInsideLimits(double relative, double absolute, double longest, const LabelBody& body,
                      NormalEquations* equations, Posture* posture) {
  const int joints = body.kinematics.num_joints();
  equations->HoldPressingJoints(posture->joint_angles);
  equations->Solve(relative, absolute);
  for (int i = 1; i < StepTuning::kSolves; ++i) {
    if (!equations->HoldOversteppingJoints(posture->joint_angles)) break;
    equations->Solve(relative, absolute);
  }
  const VectorXd& step = equations->step();
  const double length = step.tail(joints + 3).lpNorm<Eigen::Infinity>();
  const double share = length > longest ? longest / length : 1;
  posture->position += share * step.head<3>();
  posture->orientation = (posture->orientation * Exp(share * step.segment<3>(3))).normalized();
  posture->joint_angles = (posture->joint_angles + share * step.tail(joints))
                              .cwiseMax(body.kinematics.lower())
                              .cwiseMin(body.kinematics.upper());
}

}  // namespace mmm_converter
