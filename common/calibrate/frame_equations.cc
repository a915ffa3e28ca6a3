// SPDX-License-Identifier: MIT
#include "common/calibrate/frame_equations.h"

#include <cmath>
#include <utility>

#include "common/calibrate/robust_cost.h"
#include "common/fit/posture_fit.h"
#include "common/math/dense.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

// Of the distance of a marker from its place in the segment, in deviations, where it begins to
// count less.
constexpr double kSkinScale = 3;
// What a joint that no marker determines is drawn to the natural posture with [rad]. Weak: what all
// frames repeat would bend the whole body.
constexpr double kNaturalDeviation = 3;
constexpr double kOnLimit = 1e-12;  // but for rounding [rad]

}  // namespace

BodyEquations::BodyEquations(const BodyKinematics& kinematics) {
  const auto size =
      static_cast<int>(3 * kinematics.markers().size() + kinematics.lengths().segments.size());
  H = PaddedMatrix(size, size);
  g.setZero(size);
}

void BodyEquations::SetZero() {
  H.SetZero();
  g.setZero();
}

void BodyEquations::Add(const BodyEquations& other) {
  H.view() += other.H.view();
  g += other.g;
}

FrameEquations::FrameEquations(const BodyKinematics& kinematics, Eigen::Matrix3Xd z,
                               VectorXd deviation, double share)
    : at_(kinematics.MakeJacobian()),
      z_(std::move(z)),
      deviation_(std::move(deviation)),
      share_(share),
      weights_(VectorXd::Zero(z_.cols())),
      natural_(NaturalAngles(kinematics.kinematics())),
      lower_(kinematics.kinematics().lower()),
      upper_(kinematics.kinematics().upper()),
      held_(kinematics.joints().size(), 0) {
  const int n = kinematics.kinematics().num_dofs();
  const int size = BodyEquations(kinematics).size();
  H_ = PaddedMatrix(n, n);
  W_ = PaddedMatrix(size, n);
  g_.setZero(n);
  factor_ = PaddedMatrix(n, n);
  eliminated_ = PaddedMatrix(size, n);
  solved_ = PaddedMatrix(n, 1);
  step_.setZero(n);
}

void FrameEquations::DrawTo(const Posture& known, VectorXd information) {
  known_ = known;
  information_ = std::move(information);
}

double FrameEquations::Cost(const BodyKinematics& kinematics, const Posture& posture) {
  kinematics.kinematics().ComputeMarkers(posture.position, posture.orientation.toRotationMatrix(),
                                         posture.joint_angles, &at_.posture);
  double cost = 0;
  for (Eigen::Index m = 0; m < z_.cols(); ++m) {
    weights_[m] = 0;
    if (!IsSeen(z_.col(m))) continue;
    const double variance = deviation_[m] * deviation_[m];
    const double square = (z_.col(m) - at_.posture.p_WM.col(m)).squaredNorm() / variance;
    cost += CauchyCost(square, kSkinScale);
    weights_[m] = share_ * CauchyWeight(square, kSkinScale) / variance;
  }
  cost += (posture.joint_angles - natural_).squaredNorm() / (kNaturalDeviation * kNaturalDeviation);
  if (information_.size() > 0) {
    const VectorXd d = Local(posture, known_).tail(information_.size());
    cost += d.dot(information_.cwiseProduct(d));
  }
  return share_ * cost;
}

void FrameEquations::Linearize(const BodyKinematics& kinematics, const Posture& posture,
                               BodyEquations* body) {
  kinematics.Compute(posture, &at_);
  auto J_transposed = at_.posture.J_transposed.view();
  const Eigen::Index scales = at_.J_scales.cols();
  const Eigen::Index first_scale = body->size() - scales;
  auto H_body = body->H.view();
  auto W = W_.view();
  g_.setZero();
  W_.SetZero();
  for (Eigen::Index m = 0; m < z_.cols(); ++m) {
    auto J_t = J_transposed.middleCols<3>(3 * m);
    const double w = weights_[m];
    if (w == 0) {
      J_t.setZero();
      continue;
    }
    const Vector3d r = z_.col(m) - at_.posture.p_WM.col(m);
    const Matrix3d& R_WS = at_.R_WS[m];
    const auto J_scales = at_.J_scales.middleRows<3>(3 * m);
    g_.noalias() += J_t.lazyProduct(w * r);
    W.middleRows<3>(3 * m).noalias() = w * R_WS.transpose().lazyProduct(J_t.transpose());
    W.bottomRows(scales).noalias() += w * J_scales.transpose().lazyProduct(J_t.transpose());
    H_body.diagonal().segment<3>(3 * m).array() += w;
    H_body.block(first_scale, 3 * m, scales, 3).noalias() +=
        w * J_scales.transpose().lazyProduct(R_WS);
    H_body.bottomRightCorner(scales, scales).noalias() +=
        w * J_scales.transpose().lazyProduct(J_scales);
    body->g.segment<3>(3 * m) += w * R_WS.transpose() * r;
    body->g.tail(scales).noalias() += w * J_scales.transpose().lazyProduct(r);
    J_t *= std::sqrt(w);
  }
  H_.SetZero();
  AddSquare(1, at_.posture.J_transposed, &H_);
  if (kinematics.kinematics().is_root_fixed()) H_.view().diagonal().head<6>().setOnes();
  const Eigen::Index joints = natural_.size();
  const double pull = share_ / (kNaturalDeviation * kNaturalDeviation);
  H_.view().diagonal().tail(joints).array() += pull;
  g_.tail(joints) += pull * (natural_ - posture.joint_angles);
  if (information_.size() > 0) {
    const Eigen::Index angles = information_.size();
    H_.view().diagonal().tail(angles) += share_ * information_;
    g_.tail(angles) += share_ * information_.cwiseProduct(Local(posture, known_).tail(angles));
  }
  for (Eigen::Index j = 0; j < joints; ++j) {
    const double angle = posture.joint_angles[j];
    held_[j] = (angle <= lower_[j] + kOnLimit && g_[6 + j] < 0) ||
               (angle >= upper_[j] - kOnLimit && g_[6 + j] > 0);
  }
}

void FrameEquations::Eliminate(double damping, BodyEquations* body) {
  factor_ = H_;
  eliminated_ = W_;
  solved_.SetZero();
  auto H = factor_.view();
  auto solved = solved_.view().col(0);
  H.diagonal() *= 1 + damping;
  solved = g_;
  const Eigen::Index n = g_.size();
  for (std::size_t j = 0; j < held_.size(); ++j) {
    if (held_[j] == 0) continue;
    const auto i = static_cast<Eigen::Index>(6 + j);
    H.row(i).head(i).setZero();
    H.col(i).tail(n - 1 - i).setZero();
    H(i, i) = 1;
    eliminated_.view().col(i).setZero();
    solved[i] = 0;
  }
  Factorize(&factor_);
  SolveLower(factor_, &solved_);
  DivideByTransposed(factor_, &eliminated_);
  AddSquare(-1, eliminated_, &body->H);
  body->g -= eliminated_.view().lazyProduct(solved);
}

Eigen::MatrixXd FrameEquations::Slopes() const {
  Eigen::MatrixXd slopes = -eliminated_.view().transpose();
  factor_.view().transpose().triangularView<Eigen::Upper>().solveInPlace(slopes);
  return slopes;
}

const VectorXd& FrameEquations::Step(const VectorXd& body_step, const Posture& posture,
                                     double damping, NormalEquations* solver) {
  // Each solve can push another joint over its limit.
  constexpr int kSolves = 4;
  auto solved = solved_.view().col(0);
  solved -= eliminated_.view().transpose().lazyProduct(body_step);
  SolveLowerTransposed(factor_, &solved_);
  step_ = solved;
  const auto end = (posture.joint_angles + step_.tail(lower_.size())).array();
  if ((end >= lower_.array()).all() && (end <= upper_.array()).all()) return step_;
  solver->H() = H_.view();
  solver->g() = g_;
  solver->g() -= W_.view().transpose().lazyProduct(body_step);
  solver->HoldPressingJoints(posture.joint_angles);
  solver->Solve(damping, 0);
  for (int i = 1; i < kSolves && solver->HoldOversteppingJoints(posture.joint_angles); ++i) {
    solver->Solve(damping, 0);
  }
  step_ = solver->step();
  return step_;
}

}  // namespace mmm_converter
