// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/retarget/block_band.h"
#include "common/retarget/segment_jacobian.h"
#include "common/retarget/trajectory_fit.h"

namespace mmm_converter {

/// A ball at the floor in the equations of a step.
struct FloorContact {
  bool is_on = false;
  double missing = 0;      ///< to be where it may be [m]
  Eigen::RowVectorXd row;  ///< of its height
  double force = 0;        ///< that presses it down, over the stiffness; < 0: it would leave
};

/// The part of a problem's normal equations that concerns one frame alone.
class AimEquations {
 public:
  explicit AimEquations(const TrajectoryProblem& problem);

  /// Adds the aims of a frame, and what keeps bodies apart, at a posture to H (its lower half) and
  /// b, H step = b; returns the cost, the sum of squares. What nothing moves is held.
  double AddAims(int frame, const Posture& posture, Eigen::MatrixXd* H, Eigen::VectorXd* b);
  /// Of aims, of depths below the floor and of bodies that touch.
  double CostOf(int frame, const Posture& posture);
  /// At the posture of the last AddAims.
  double CostOfFloor() const;
  /// Adds what keeps the balls above the floor, at the posture of the last AddAims. A ball that
  /// was pressed down by the step before stays on the floor.
  void AddFloor(double stiffness, std::vector<FloorContact>* contacts, Eigen::MatrixXd* H,
                Eigen::VectorXd* b);
  /// How a step presses the balls that AddFloor has put on the floor.
  void FindForces(const Eigen::VectorXd& step, std::vector<FloorContact>* contacts) const;
  /// Of the lowest ball below the floor [m]; < 0: above it.
  double DepthOf(const Posture& posture);

 private:
  double AddTouches(Eigen::MatrixXd* H, Eigen::VectorXd* b);
  /// Of the pairs that are too near; each(first, second, touch, missing [m]).
  template <typename Each>
  double CostOfTouches(Each each);
  void AddRows(int segment, const Eigen::Vector3d& weight, const Eigen::Vector3d& residual,
               Eigen::MatrixXd* H, Eigen::VectorXd* b) const;

  const TrajectoryProblem& problem_;
  SegmentJacobian jacobian_;
  SegmentJacobian::Rows rows_;
  PlacedCapsules placed_;
  Eigen::VectorXd touch_row_;
};

/// Frames of a trajectory that are solved at once, behind two that stay.
class TrajectoryWindow {
 public:
  explicit TrajectoryWindow(const TrajectoryProblem& problem);

  /// Frames [begin, end).
  void Begin(int begin, int end);
  /// One step of all of its frames; returns how far it moved a joint at most [rad].
  double Step(std::vector<Posture>* postures);
  bool IsWithinLimits(const std::vector<Posture>& postures);
  bool is_solved() const { return is_solved_; }  ///< some step had a solution

 private:
  /// What the aims of a frame alone are by the equations of a step.
  struct FrameAims {
    double cost = 0, floor_cost = 0;
    Eigen::MatrixXd H;
    Eigen::VectorXd b;
  };

  void Assemble(const std::vector<Posture>& postures);
  void AddSmoothness(const std::vector<Posture>& postures);
  void AddLimits(const std::vector<Posture>& postures);
  /// Goes a part of the step. False: the aims' directions and places bend away from what their
  /// equations foretell. Limits do not count: their equations are exact.
  bool Try(double part, std::vector<Posture>* postures);

  const TrajectoryProblem& problem_;
  AimEquations equations_;
  int begin_ = 0, end_ = 0;
  bool is_solved_ = false;
  BlockBand band_;
  std::vector<FrameAims> aims_;
  std::vector<std::vector<FloorContact>> contacts_;  ///< of each frame
  double damping_ = 0, stiffness_ = 0;
  std::vector<Posture> before_;  ///< the last step
  Eigen::VectorXd smoothness_;   ///< weight of squared second differences
  Eigen::VectorXd most_step_;    ///< of a joint from frame to frame, less a margin
  Eigen::VectorXd lower_, upper_;
};

}  // namespace mmm_converter
