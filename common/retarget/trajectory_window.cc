// SPDX-License-Identifier: MIT
#include "common/retarget/trajectory_window.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/math/rotation.h"
#include "common/math/square.h"

namespace mmm_converter {
namespace {

constexpr double kFirstStiffness = 1e5;   // of limits of joints [1/rad^2], tenfold each step
constexpr double kStiffness = 1e8;        // of limits of joints [1/rad^2]
constexpr double kFloorStiffness = 1e7;   // [1/m^2]
constexpr double kStepMargin = 0.01;      // of velocity limits: what the stiffness leaves is less
constexpr double kPositionMargin = 2e-4;  // [rad]
constexpr double kFloorMargin = 3e-4;     // [m] that a foot may be below the floor
constexpr double kFloorTolerance = 3e-4;  // [m]
constexpr double kFirstDamping = 100;     // of steps [1/rad^2]
constexpr double kLeastDamping = 0.01;
constexpr double kWorse = 1.02;       // of the cost before, that makes steps shorter
constexpr double kMuchWorse = 1.5;    // that undoes a step
constexpr double kLongestStep = 0.7;  // [rad]
constexpr double kUnmoved = 1.0;      // weight of what nothing moves

/// How far a value is beyond its limits; within them 0.
double Excess(double value, double lower, double upper) {
  return value - std::clamp(value, lower, upper);
}

}  // namespace

FrameEquations::FrameEquations(const TrajectoryProblem& problem)
    : problem_(problem), jacobian_(*problem.model) {}

void FrameEquations::AddRows(int segment, const Eigen::Vector3d& weight,
                             const Eigen::Vector3d& residual, Eigen::MatrixXd* H,
                             Eigen::VectorXd* b) const {
  const std::vector<int>& columns = jacobian_.columns(segment);
  const Eigen::Vector3d squared = weight.cwiseAbs2();
  const Eigen::Vector3d pull = squared.cwiseProduct(residual);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Eigen::Vector3d column = rows_.col(static_cast<Eigen::Index>(i));
    const Eigen::Vector3d weighted = squared.cwiseProduct(column);
    (*b)[columns[i]] += column.dot(pull);
    for (std::size_t j = 0; j <= i; ++j) {
      (*H)(columns[i], columns[j]) += weighted.dot(rows_.col(static_cast<Eigen::Index>(j)));
    }
  }
}

double FrameEquations::AddAims(int frame, const Posture& posture, Eigen::MatrixXd* H,
                               Eigen::VectorXd* b) {
  jacobian_.Compute(posture);
  double cost = 0;
  for (const Aim& aim : problem_.aims) {
    const Eigen::Vector3d weight = aim.weight.col(frame);
    if (weight.isZero(0)) continue;
    const Eigen::Isometry3d& X = jacobian_.X_WS(aim.segment);
    const Eigen::Vector3d now = aim.is_direction ? X.linear() * aim.local : X * aim.local;
    if (aim.is_direction) jacobian_.OfDirection(aim.segment, now, &rows_);
    if (!aim.is_direction) jacobian_.OfPoint(aim.segment, now, &rows_);
    const Eigen::Vector3d residual = aim.target.col(frame) - now;
    cost += weight.cwiseProduct(residual).squaredNorm();
    AddRows(aim.segment, weight, residual, H, b);
  }
  const double rest = 1 / Square(problem_.rest_deviation);
  const Eigen::Index joints = posture.joint_angles.size();
  H->diagonal().tail(joints).array() += rest;
  b->tail(joints) += rest * (problem_.rest - posture.joint_angles);
  if (problem_.model->is_root_fixed()) H->diagonal().head<6>().array() += kUnmoved;
  return cost;
}

double FrameEquations::AddFloor(Eigen::MatrixXd* H, Eigen::VectorXd* b) {
  double deepest = 0;
  for (std::size_t i = 0; i < problem_.balls.size(); ++i) {
    const FloorBall& ball = problem_.balls[i];
    const Eigen::Vector3d p = jacobian_.X_WS(ball.segment) * ball.p_S;
    const double height = p.z() - ball.radius;
    deepest = std::max(deepest, -height);
    if (height > -kFloorMargin) continue;
    jacobian_.OfPoint(ball.segment, p, &rows_);
    const double residual = -kFloorMargin - height;
    AddRows(ball.segment, {0, 0, std::sqrt(kFloorStiffness)}, {0, 0, residual}, H, b);
  }
  return deepest;
}

TrajectoryWindow::TrajectoryWindow(const TrajectoryProblem& problem)
    : problem_(problem), equations_(problem) {
  const int joints = problem.model->num_joints();
  const auto weight = [&](double acceleration) {
    return Square(Square(problem.rate) / acceleration);
  };
  smoothness_.resize(6 + joints);
  smoothness_.head<3>().setConstant(weight(problem.root_acceleration));
  smoothness_.segment<3>(3).setConstant(weight(problem.root_turning));
  smoothness_.tail(joints).setConstant(weight(problem.joint_acceleration));
  most_step_ = (1 - kStepMargin) / problem.rate * problem.velocity_limits;
  lower_.resize(joints);
  upper_.resize(joints);
  for (int j = 0; j < joints; ++j) {
    const Segment& joint = problem.model->joint(j);
    const double margin = std::min(kPositionMargin, 0.1 * (joint.upper - joint.lower));
    lower_[j] = joint.lower + margin;
    upper_[j] = joint.upper - margin;
  }
}

void TrajectoryWindow::Begin(int begin, int end) {
  begin_ = begin;
  end_ = end;
  damping_ = kFirstDamping;
  stiffness_ = kFirstStiffness;
  cost_ = std::numeric_limits<double>::infinity();
  band_.Resize(end - begin, 6 + problem_.model->num_joints());
}

double TrajectoryWindow::AddSmoothness(const std::vector<Posture>& postures) {
  double cost = 0;
  const Eigen::VectorXd& w = smoothness_;
  Eigen::VectorXd difference(w.size());
  for (int k = std::max(1, begin_ - 1); k < end_ - 1; ++k) {
    const Posture &a = postures[k - 1], &b = postures[k], &c = postures[k + 1];
    difference.head<3>() = c.position - 2 * b.position + a.position;
    difference.segment<3>(3) = Log(b.orientation.conjugate() * c.orientation) -
                               Log(a.orientation.conjugate() * b.orientation);
    difference.tail(w.size() - 6) = c.joint_angles - 2 * b.joint_angles + a.joint_angles;
    const Eigen::VectorXd pull = w.cwiseProduct(difference);
    const int i = k - begin_;  // of b
    if (i >= 1) {
      band_.diagonal[i - 1].diagonal() += w;
      band_.right[i - 1] -= pull;
      band_.before[i] -= 2 * w;
    }
    if (i >= 0) {
      band_.diagonal[i].diagonal() += 4 * w;
      band_.right[i] += 2 * pull;
      band_.before[i + 1] -= 2 * w;
    }
    band_.diagonal[i + 1].diagonal() += w;
    band_.right[i + 1] -= pull;
    if (i >= 1) band_.before2[i + 1] += w;
    cost += difference.dot(pull);
  }
  return cost;
}

void TrajectoryWindow::AddLimits(const std::vector<Posture>& postures) {
  const int joints = problem_.model->num_joints();
  for (int k = begin_; k < end_; ++k) {
    const int i = k - begin_;
    for (int j = 0; j < joints; ++j) {
      const double q = postures[k].joint_angles[j];
      const double beyond = Excess(q, lower_[j], upper_[j]);
      if (beyond != 0) {
        band_.diagonal[i](6 + j, 6 + j) += stiffness_;
        band_.right[i][6 + j] -= stiffness_ * beyond;
      }
      if (k == 0 || std::isinf(most_step_[j])) continue;
      const double step = q - postures[k - 1].joint_angles[j];
      const double drag = stiffness_ * Excess(step, -most_step_[j], most_step_[j]);
      if (drag == 0) continue;
      band_.diagonal[i](6 + j, 6 + j) += stiffness_;
      band_.right[i][6 + j] -= drag;
      if (i == 0) continue;
      band_.diagonal[i - 1](6 + j, 6 + j) += stiffness_;
      band_.right[i - 1][6 + j] += drag;
      band_.before[i][6 + j] -= stiffness_;
    }
  }
}

double TrajectoryWindow::Assemble(const std::vector<Posture>& postures) {
  band_.SetZero();
  double cost = 0;
  deepest_ = 0;
  for (int k = begin_; k < end_; ++k) {
    const int i = k - begin_;
    cost += equations_.AddAims(k, postures[k], &band_.diagonal[i], &band_.right[i]);
    const double depth = equations_.AddFloor(&band_.diagonal[i], &band_.right[i]);
    deepest_ = std::max(deepest_, depth);
  }
  return cost + AddSmoothness(postures);
}

double TrajectoryWindow::Step(std::vector<Posture>* postures) {
  double cost = Assemble(*postures);
  if (cost > kMuchWorse * cost_) {
    std::copy(before_.begin(), before_.end(), postures->begin() + begin_);
    cost = Assemble(*postures);
    damping_ *= 10;
  }
  damping_ = cost > kWorse * cost_ ? 4 * damping_ : std::max(0.25 * damping_, kLeastDamping);
  cost_ = cost;
  AddLimits(*postures);
  stiffness_ = std::min(10 * stiffness_, kStiffness);
  for (Eigen::MatrixXd& block : band_.diagonal) block.diagonal().array() += damping_;
  if (!SolveInPlace(&band_)) return 0;
  before_.assign(postures->begin() + begin_, postures->begin() + end_);
  double longest = 0;
  for (const Eigen::VectorXd& step : band_.right) {
    longest = std::max(longest, step.tail(step.size() - 3).cwiseAbs().maxCoeff());
  }
  const double part = std::min(1.0, kLongestStep / longest);
  for (int k = begin_; k < end_; ++k) {
    (*postures)[k] = Retract((*postures)[k], part * band_.right[k - begin_]);
  }
  return longest;
}

bool TrajectoryWindow::IsWithinLimits(const std::vector<Posture>& postures) const {
  if (deepest_ > kFloorMargin + kFloorTolerance) return false;
  for (int k = begin_; k < end_; ++k) {
    const Eigen::VectorXd& q = postures[k].joint_angles;
    if (((q - lower_).array() < -kPositionMargin).any()) return false;
    if (((upper_ - q).array() < -kPositionMargin).any()) return false;
    if (k == 0) continue;
    const Eigen::ArrayXd step = (q - postures[k - 1].joint_angles).array().abs();
    if ((step * (1 - kStepMargin) > most_step_.array() * (1 - 1e-6)).any()) return false;
  }
  return true;
}

}  // namespace mmm_converter
