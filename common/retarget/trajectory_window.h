// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/retarget/block_band.h"
#include "common/retarget/segment_jacobian.h"
#include "common/retarget/trajectory_fit.h"

namespace mmm_converter {

/// The part of a problem's normal equations that concerns one frame alone.
class FrameEquations {
 public:
  explicit FrameEquations(const TrajectoryProblem& problem);

  const KinematicModel& model() const { return *problem_.model; }

  /// Adds the aims of a frame at a posture to H (its lower half) and b, H step = b; returns the
  /// cost, the sum of squares. What nothing moves is held.
  double AddAims(int frame, const Posture& posture, Eigen::MatrixXd* H, Eigen::VectorXd* b);
  /// Adds what keeps the balls above the floor, at the posture of the last AddAims. Returns the
  /// largest depth [m].
  double AddFloor(Eigen::MatrixXd* H, Eigen::VectorXd* b);

 private:
  void AddRows(int segment, const Eigen::Vector3d& weight, const Eigen::Vector3d& residual,
               Eigen::MatrixXd* H, Eigen::VectorXd* b) const;

  const TrajectoryProblem& problem_;
  SegmentJacobian jacobian_;
  SegmentJacobian::Rows rows_;
};

/// Frames of a trajectory that are solved at once, behind two that stay.
class TrajectoryWindow {
 public:
  explicit TrajectoryWindow(const TrajectoryProblem& problem);

  /// Frames [begin, end).
  void Begin(int begin, int end);
  /// One step of all of its frames; returns the longest of a joint [rad].
  double Step(std::vector<Posture>* postures);
  bool IsWithinLimits(const std::vector<Posture>& postures) const;

 private:
  /// All but limits of joints; returns the cost.
  double Assemble(const std::vector<Posture>& postures);
  /// Returns the cost.
  double AddSmoothness(const std::vector<Posture>& postures);
  void AddLimits(const std::vector<Posture>& postures);

  const TrajectoryProblem& problem_;
  FrameEquations equations_;
  int begin_ = 0, end_ = 0;
  BlockBand band_;
  double damping_ = 0, stiffness_ = 0, cost_ = 0;
  double deepest_ = 0;           ///< below the floor before the last step [m]
  std::vector<Posture> before_;  ///< the last step
  Eigen::VectorXd smoothness_;   ///< weight of squared second differences
  Eigen::VectorXd most_step_;    ///< of a joint from frame to frame, less a margin
  Eigen::VectorXd lower_, upper_;
};

}  // namespace mmm_converter
