// SPDX-License-Identifier: MIT
#include "common/label/search/posture_step.h"

#include "common/label/search/body_match.h"
#include "common/math/rotation.h"

namespace mmm_converter {

using Eigen::VectorXd;

void StepTowards(const Eigen::Ref<const Eigen::Matrix3Xd>& targets, const VectorXd& noise,
                 double robust_distance, const LabelBody& body, NormalEquations* equations,
                 Posture* posture) {
  constexpr double kDamping = 0.01;         // relative
  constexpr double kLeastCurvature = 1e-3;  // [1/m^2], [1/rad^2]
  constexpr double kLongestStep = 0.6;      // [rad]
  constexpr int kSolves = 3;
  const int joints = body.kinematics.num_joints();
  equations->Linearize(targets, noise, robust_distance);
  equations->H().diagonal().tail(joints).array() += MatchCosts::kNaturalWeight;
  equations->g().tail(joints) +=
      MatchCosts::kNaturalWeight * (body.natural_angles - posture->joint_angles);
  equations->HoldPressingJoints(posture->joint_angles);
  equations->Solve(kDamping, kLeastCurvature);
  for (int i = 1; i < kSolves && equations->HoldOversteppingJoints(posture->joint_angles); ++i) {
    equations->Solve(kDamping, kLeastCurvature);
  }
  const VectorXd& step = equations->step();
  const double longest = step.tail(joints + 3).lpNorm<Eigen::Infinity>();
  const double share = longest > kLongestStep ? kLongestStep / longest : 1;
  posture->position += share * step.head<3>();
  posture->orientation = (posture->orientation * Exp(share * step.segment<3>(3))).normalized();
  posture->joint_angles = (posture->joint_angles + share * step.tail(joints))
                              .cwiseMax(body.kinematics.lower())
                              .cwiseMin(body.kinematics.upper());
}

}  // namespace mmm_converter
