// SPDX-License-Identifier: MIT
#include "common/retarget/trajectory_window.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/math/rotation.h"
#include "common/math/square.h"

namespace mmm_converter {
namespace {

// Springs at limits of joints and at the floor [1/rad^2, 1/m^2], tenfold each step: at last firm
// against any aim.
constexpr double kFirstStiffness = 1e6, kStiffness = 1e10, kFloorStiffness = 1e9;
constexpr double kStepMargin = 0.002;     // of velocity limits: what the stiffness leaves is less
constexpr double kPositionMargin = 2e-4;  // [rad]
constexpr double kFloorMargin = 2e-4;     // [m] that a foot may be below the floor
constexpr double kFloorReach = 0.01;      // [m] within which what was pressed down stays
constexpr double kFloorWeight = 1e7;      // [1/m^2] of depth in what a step makes worse
constexpr double kFloorTolerance = 2e-4;  // [m]
constexpr double kFirstDamping = 100;     // of steps [1/rad^2]
constexpr double kLeastDamping = 10;
constexpr double kWorse = 1.5;        // of the cost of aims as it was or as a step foretells it
constexpr int kHalvings = 4;          // of a step that makes it worse
constexpr double kLongestStep = 0.7;  // [rad]
constexpr double kApart = 0.003;      // [m] between bodies that are kept apart
constexpr double kTouchDeviation = 0.002;  // [m]
constexpr double kUnmoved = 1.0;           // weight of what nothing moves
constexpr double kHoldsFirmly = 1e8;       // [1/rad^2, 1/m^2] of what is held, against any aim

/// How far a value is beyond its limits; within them 0.
double Excess(double value, double lower, double upper) {
  return value - std::clamp(value, lower, upper);
}

}  // namespace

AimEquations::AimEquations(const TrajectoryProblem& problem)
    : problem_(problem), jacobian_(*problem.model) {}

void AimEquations::AddRows(int segment, const Eigen::Vector3d& weight,
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

template <typename Each>
double AimEquations::CostOfTouches(Each each) {
  double cost = 0;
  if (problem_.capsules == nullptr) return cost;
  const RobotCapsules& capsules = *problem_.capsules;
  PlaceCapsules(capsules, jacobian_.poses(), &placed_);
  for (const std::pair<int, int>& pair : capsules.pairs) {
    const Touch touch = FindTouch(capsules, placed_, pair, kApart);
    const double missing = touch.depth + kApart;
    if (missing <= 0) continue;
    cost += Square(missing / kTouchDeviation);
    each(capsules.bodies[pair.first], capsules.bodies[pair.second], touch, missing);
  }
  return cost;
}

double AimEquations::AddTouches(Eigen::MatrixXd* H, Eigen::VectorXd* b) {
  return CostOfTouches(
      [&](const CapsuleBody& first, const CapsuleBody& second, const Touch& touch, double missing) {
        const Eigen::Vector3d between = touch.p_first - touch.p_second;
        if (between.isZero()) return;
        const Eigen::Vector3d apart = between.normalized();
        touch_row_.setZero(b->size());
        const auto add = [&](const CapsuleBody& body, const Eigen::Vector3d& p, double sign) {
          jacobian_.OfPoint(body.segment, p, &rows_);
          const std::vector<int>& columns = jacobian_.columns(body.segment);
          for (std::size_t i = 0; i < columns.size(); ++i) {
            if (columns[i] < 6) continue;  // the root moves both
            touch_row_[columns[i]] += sign * apart.dot(rows_.col(static_cast<Eigen::Index>(i)));
          }
        };
        add(first, touch.p_first, 1);
        add(second, touch.p_second, -1);
        const double weight = 1 / Square(kTouchDeviation);
        for (Eigen::Index i = 6; i < touch_row_.size(); ++i) {
          if (touch_row_[i] == 0) continue;
          (*b)[i] += weight * missing * touch_row_[i];
          H->row(i).head(i + 1) += weight * touch_row_[i] * touch_row_.head(i + 1).transpose();
        }
      });
}

double AimEquations::AddAims(int frame, const Posture& posture, Eigen::MatrixXd* H,
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
  cost += AddTouches(H, b);
  const double rest = 1 / Square(problem_.rest_deviation);
  const Eigen::Index joints = posture.joint_angles.size();
  H->diagonal().tail(joints).array() += rest;
  b->tail(joints) += rest * (problem_.rest - posture.joint_angles);
  for (const int joint : problem_.held) {
    (*H)(6 + joint, 6 + joint) += kHoldsFirmly;
    (*b)[6 + joint] += kHoldsFirmly * (problem_.rest[joint] - posture.joint_angles[joint]);
  }
  if (problem_.model->is_root_fixed()) H->diagonal().head<6>().array() += kUnmoved;
  return cost;
}

double AimEquations::CostOf(int frame, const Posture& posture) {
  jacobian_.Compute(posture);
  double cost = 0;
  for (const Aim& aim : problem_.aims) {
    const Eigen::Isometry3d& X = jacobian_.X_WS(aim.segment);
    const Eigen::Vector3d now = aim.is_direction ? X.linear() * aim.local : X * aim.local;
    cost += aim.weight.col(frame).cwiseProduct(aim.target.col(frame) - now).squaredNorm();
  }
  return cost + CostOfFloor() + CostOfTouches([](const auto&...) {});
}

double AimEquations::CostOfFloor() const {
  double cost = 0;
  for (const FloorBall& ball : problem_.balls) {
    const double height = (jacobian_.X_WS(ball.segment) * ball.p_S).z() - ball.radius;
    cost += kFloorWeight * Square(std::min(0.0, height + kFloorMargin));
  }
  return cost;
}

void AimEquations::AddFloor(double stiffness, std::vector<FloorContact>* contacts,
                            Eigen::MatrixXd* H, Eigen::VectorXd* b) {
  contacts->resize(problem_.balls.size());
  for (std::size_t i = 0; i < problem_.balls.size(); ++i) {
    const FloorBall& ball = problem_.balls[i];
    FloorContact& contact = (*contacts)[i];
    const Eigen::Vector3d p = jacobian_.X_WS(ball.segment) * ball.p_S;
    contact.missing = -kFloorMargin - (p.z() - ball.radius);
    contact.is_on = contact.missing > (contact.force > 0 ? -kFloorReach : 0);
    if (!contact.is_on) continue;
    jacobian_.OfPoint(ball.segment, p, &rows_);
    contact.row =
        rows_.row(2).head(static_cast<Eigen::Index>(jacobian_.columns(ball.segment).size()));
    AddRows(ball.segment, {0, 0, std::sqrt(stiffness)}, {0, 0, contact.missing}, H, b);
  }
}

void AimEquations::FindForces(const Eigen::VectorXd& step,
                              std::vector<FloorContact>* contacts) const {
  for (std::size_t i = 0; i < problem_.balls.size(); ++i) {
    FloorContact& contact = (*contacts)[i];
    contact.force = 0;
    if (!contact.is_on) continue;
    const std::vector<int>& columns = jacobian_.columns(problem_.balls[i].segment);
    contact.force = contact.missing;
    for (std::size_t j = 0; j < columns.size(); ++j) {  // step(columns) would copy them
      contact.force -= contact.row[static_cast<Eigen::Index>(j)] * step[columns[j]];
    }
  }
}

double AimEquations::DepthOf(const Posture& posture) {
  jacobian_.Compute(posture);
  double deepest = -std::numeric_limits<double>::infinity();
  for (const FloorBall& ball : problem_.balls) {
    const Eigen::Vector3d p = jacobian_.X_WS(ball.segment) * ball.p_S;
    deepest = std::max(deepest, ball.radius - p.z());
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
  is_solved_ = false;
  damping_ = kFirstDamping;
  stiffness_ = kFirstStiffness;
  band_.Resize(end - begin, 6 + problem_.model->num_joints());
  aims_.resize(end - begin);
  contacts_.assign(end - begin, {});
}

void TrajectoryWindow::AddSmoothness(const std::vector<Posture>& postures) {
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
  }
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

void TrajectoryWindow::Assemble(const std::vector<Posture>& postures) {
  band_.SetZero();
  for (int k = begin_; k < end_; ++k) {
    const int i = k - begin_;
    FrameAims& aims = aims_[i];
    aims.cost = equations_.AddAims(k, postures[k], &band_.diagonal[i], &band_.right[i]);
    aims.floor_cost = equations_.CostOfFloor();
    aims.H = band_.diagonal[i];
    aims.b = band_.right[i];
    equations_.AddFloor(std::min(stiffness_, kFloorStiffness), &contacts_[i], &band_.diagonal[i],
                        &band_.right[i]);
  }
  AddSmoothness(postures);
  AddLimits(postures);
  for (Eigen::MatrixXd& block : band_.diagonal) block.diagonal().array() += damping_;
}

bool TrajectoryWindow::Try(double part, std::vector<Posture>* postures) {
  double before = 0, foretold = 0, cost = 0;
  for (int k = begin_; k < end_; ++k) {
    const FrameAims& aims = aims_[k - begin_];
    const Eigen::VectorXd step = part * band_.right[k - begin_];
    (*postures)[k] = Retract(before_[k - begin_], step);
    before += aims.cost + aims.floor_cost;
    foretold +=
        aims.cost - 2 * aims.b.dot(step) + step.dot(aims.H.selfadjointView<Eigen::Lower>() * step);
    cost += equations_.CostOf(k, (*postures)[k]);
  }
  return cost <= kWorse * std::max(before, foretold);
}

double TrajectoryWindow::Step(std::vector<Posture>* postures) {
  Assemble(*postures);
  stiffness_ = std::min(10 * stiffness_, kStiffness);
  if (!SolveInPlace(&band_)) {
    damping_ *= 100;
    return kLongestStep;
  }
  is_solved_ = true;
  before_.assign(postures->begin() + begin_, postures->begin() + end_);
  double longest = 0;
  for (int i = 0; i < end_ - begin_; ++i) {
    const Eigen::VectorXd& step = band_.right[i];
    equations_.FindForces(step, &contacts_[i]);
    longest = std::max(longest, step.tail(step.size() - 3).cwiseAbs().maxCoeff());
  }
  double part = std::min(1.0, kLongestStep / longest);
  damping_ = std::max((part < 1 ? 4 : 0.25) * damping_, kLeastDamping);
  for (int n = 0; !Try(part, postures) && n < kHalvings; ++n) {
    part *= 0.5;
    damping_ *= 4;
  }
  return part * longest;
}

bool TrajectoryWindow::IsWithinLimits(const std::vector<Posture>& postures) {
  for (int k = begin_; k < end_; ++k) {
    if (equations_.DepthOf(postures[k]) > kFloorMargin + kFloorTolerance) return false;
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
