// SPDX-License-Identifier: MIT
#include "common/label/track/label_belief.h"

#include <algorithm>
#include <cmath>

#include "common/label/tuning.h"
#include "common/math/dense.h"
#include "common/math/square.h"

namespace mmm_converter {

using Eigen::MatrixXd;

namespace {

const MovementTuning::Kind& MovementOf(Eigen::Index dof) {
  return dof < 3 ? MovementTuning::kRoot : dof < 6 ? MovementTuning::kTurn : MovementTuning::kJoint;
}

bool HasPoint(const LabelBody& body, const std::vector<int>& point_of_marker, int dof) {
  for (int m = 0; m < body.num_markers(); ++m) {
    if (point_of_marker[m] >= 0 && (dof < 6 || body.kinematics.Moves(dof - 6, m))) return true;
  }
  return false;
}

}  // namespace

LabelBelief BeliefAt(const LabelBody& body, const Posture& posture) {
  const int dofs = body.kinematics.num_dofs();
  LabelBelief belief;
  belief.posture = posture;
  belief.velocity.setZero(dofs);
  belief.speed.resize(dofs);
  belief.P_qq.setZero(dofs, dofs);
  belief.P_qv.setZero(dofs, dofs);
  belief.P_vv.setZero(dofs, dofs);
  for (int i = 0; i < dofs; ++i) {
    belief.speed[i] = MovementOf(i).speed;
    belief.P_qq(i, i) = Square(MovementOf(i).start);
    belief.P_vv(i, i) = Square(belief.speed[i]);
  }
  belief.offset.setZero(3, body.num_markers());
  belief.offset_variance = body.place.array().square();
  return belief;
}

Posture LabelBelief::PostureAfter(const LabelBody& body, double dt) const {
  const double a =
      MovementTuning::kVelocityMemory * (1 - std::exp(-dt / MovementTuning::kVelocityMemory));
  Posture after = Retract(posture, a * velocity);
  after.joint_angles =
      after.joint_angles.cwiseMax(body.kinematics.lower()).cwiseMin(body.kinematics.upper());
  return after;
}

void LabelBelief::Predict(const LabelBody& body, double dt) {
  const double b = std::exp(-dt / MovementTuning::kVelocityMemory);
  const double a = MovementTuning::kVelocityMemory * (1 - b);
  posture = PostureAfter(body, dt);
  velocity *= b;
  P_qq += a * (P_qv + P_qv.transpose()) + a * a * P_vv;
  P_qv = b * (P_qv + a * P_vv);
  P_vv *= b * b;
  const double tau2 = Square(MovementTuning::kVelocityMemory);
  for (int i = 0; i < P_qq.rows(); ++i) {
    const double variance = Square(speed[i]);
    P_qq(i, i) +=
        variance * 2 * tau2 * (dt / MovementTuning::kVelocityMemory - 1.5 + 2 * b - 0.5 * b * b);
    P_qv(i, i) += variance * MovementTuning::kVelocityMemory * Square(1 - b);
    P_vv(i, i) += variance * (1 - b * b);
  }
  // A joint is within its limits, whatever was not seen.
  for (int j = 0; j < body.kinematics.num_joints(); ++j) {
    const int i = 6 + j;
    const auto [lower, upper] = body.kinematics.Range(j);
    const double most = Square(upper - lower) / 12;
    if (P_qq(i, i) <= most) continue;
    const double share = std::sqrt(most / P_qq(i, i));
    P_qq.row(i) *= share;
    P_qq.col(i) *= share;
    P_qv.row(i) *= share;
  }
}

// The velocities learn of the frame through what they have in common with the posture.
void LabelBelief::Correct(const MatrixXd& prior, const Posture& corrected, const MatrixXd& P,
                          Scratch* scratch) {
  PaddedMatrix& gain = scratch->gain;
  PaddedMatrix& factor = scratch->factor;
  PaddedMatrix& product = scratch->product;
  factor.view() = P_qv.transpose();
  product.view() = prior;
  Multiply(1, factor, product, &gain);
  velocity += gain.view() * Local(posture, corrected);
  factor.view() = P_qq - P;
  Multiply(1, gain, factor, &product);
  MultiplyByTransposed(product, gain, &factor);
  P_vv -= factor.view();
  factor.view() = P;
  MultiplyByTransposed(factor, gain, &product);
  P_qv = product.view();
  P_qq = P;
  posture = corrected;
}

void LabelBelief::ExpectSpeeds(const LabelBody& body, const std::vector<int>& point_of_marker,
                               double dt) {
  const double kept = std::exp(-dt / MovementTuning::kSpeedMemory);
  for (int i = 0; i < speed.size(); ++i) {
    const double most = MovementOf(i).speed;
    const double seen = std::clamp(MovementTuning::kFaster * std::abs(velocity[i]),
                                   MovementTuning::kSlowest * most, most);
    const double now = Square(HasPoint(body, point_of_marker, i) ? seen : most);
    speed[i] = std::sqrt(std::max(now, kept * Square(speed[i]) + (1 - kept) * now));
  }
}

}  // namespace mmm_converter
