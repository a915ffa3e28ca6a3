// SPDX-License-Identifier: MIT
#include "common/label/search/moving_body.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "common/label/search/posture_step.h"
#include "common/label/tuning.h"

namespace mmm_converter {

using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::Ref;
using Eigen::Vector3d;
using Eigen::VectorXd;

const VectorXd& WholeBody::Variances(double spread) {
  variances_ = body_.place.array().square() + spread * spread;
  return variances_;
}

void WholeBody::Step(const Matrix3Xd& targets, const VectorXd& noise, Posture* posture) {
  StepTowards(targets, noise, StepTuning::kNoRobustDistance, body_, &equations_, posture);
}

double WholeBody::PostureCost(const Posture& posture) const {
  return MatchCosts::kNaturalWeight * (posture.joint_angles - body_.natural_angles).squaredNorm();
}

const Matrix3Xd& MovingLimb::Place(const Posture& posture) {
  body_.kinematics.ComputeMarkers(posture.position, posture.orientation.toRotationMatrix(),
                                  posture.joint_angles, &at_);
  places_ = at_.p_WM(Eigen::all, limb_->markers);
  return places_;
}

const VectorXd& MovingLimb::Variances(double spread) {
  variances_ = body_.place(limb_->markers).array().square() + spread * spread;
  return variances_;
}

double MovingLimb::PostureCost(const Posture& posture) const {
  return MatchCosts::kNaturalWeight *
         (posture.joint_angles(limb_->joints) - body_.natural_angles(limb_->joints)).squaredNorm();
}

void MovingLimb::StepAbout(const VectorXd& resting, const Matrix3Xd& targets, const VectorXd& noise,
                           Posture* posture) {
  const auto joints = static_cast<Eigen::Index>(limb_->joints.size());
  body_.kinematics.ComputeJacobian(&at_);
  const auto J_transposed = at_.J_transposed.view();
  H_.setZero(joints, joints);
  g_.setZero(joints);
  J_.resize(joints, 3);
  for (std::size_t i = 0; i < limb_->markers.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const Vector3d r = targets.col(column) - places_.col(column);
    if (!r.allFinite()) continue;
    const double weight = 1 / (noise[column] * noise[column]);
    for (Eigen::Index j = 0; j < joints; ++j) {
      J_.row(j) = J_transposed.block<1, 3>(6 + limb_->joints[j], 3 * limb_->markers[i]);
    }
    H_.noalias() += weight * J_ * J_.transpose();
    g_.noalias() += weight * J_ * r;
  }
  for (Eigen::Index j = 0; j < joints; ++j) {
    const int joint = limb_->joints[j];
    const double angle = posture->joint_angles[joint];
    H_(j, j) += MatchCosts::kNaturalWeight;
    g_[j] += MatchCosts::kNaturalWeight * (resting[joint] - angle);
    const bool is_pressing = (angle <= body_.kinematics.lower()[joint] && g_[j] < 0) ||
                             (angle >= body_.kinematics.upper()[joint] && g_[j] > 0);
    if (is_pressing) {
      H_.row(j).setZero();
      H_.col(j).setZero();
      H_(j, j) = 1;
      g_[j] = 0;
    }
    H_(j, j) *= 1 + StepTuning::kDamping;
  }
  const Eigen::LLT<Ref<MatrixXd>> factor(H_);
  factor.solveInPlace(g_);
  const double longest = g_.lpNorm<Eigen::Infinity>();
  const double share = longest > StepTuning::kLongest ? StepTuning::kLongest / longest : 1;
  for (Eigen::Index j = 0; j < joints; ++j) {
    const int joint = limb_->joints[j];
    posture->joint_angles[joint] =
        std::clamp(posture->joint_angles[joint] + share * g_[j], body_.kinematics.lower()[joint],
                   body_.kinematics.upper()[joint]);
  }
}

}  // namespace mmm_converter
