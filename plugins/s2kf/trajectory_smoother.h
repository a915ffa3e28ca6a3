// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "common/math/padded_matrix.h"
#include "plugins/s2kf/belief.h"
#include "plugins/s2kf/joint_limit_transform.h"
#include "plugins/s2kf/motion_model.h"

namespace mmm_converter::s2kf {

/// The Rauch-Tung-Striebel smoother over a filter's beliefs, backwards, in the error state: what
/// all frames say of each. With x+ = F x + w, w ~ N(0, Q), and the filter's prediction (x-, P-) of
/// the next frame, whose smoothed belief is (x_s, S):
///   x = x_filtered + F^-1 A (x_s - x-),   P = F^-1 (A S A^T + A Q) F^-T,   A = I - Q (P-)^-1,
/// which is the usual gain P F^T (P-)^-1 = F^-1 A, without a difference of nearly equal matrices.
class TrajectorySmoother {
 public:
  /// num_states: of a belief, without rates. All must be those of the filter.
  TrajectorySmoother(const MotionModel& motion_model, const JointLimitTransform& transform,
                     RootParameters root, int num_states);

  /// The last frame: its filtered belief is the smoothed one.
  void Start(const Belief& last) { smoothed_ = last; }

  /// The frame dt seconds before the latest one, from its filtered belief.
  void StepBack(const Belief& filtered, double dt);

  const Belief& belief() const { return smoothed_; }

  /// The belief with parameters no farther from those of `filtered`, of the same frame, than the
  /// pass holds, which is linear about the filter's track: beside a limit they may go any way, as
  /// no angle follows.
  void EstimateAbout(const Belief& filtered, Belief* estimate) const;

 private:
  void ComputeGain();
  void SmoothMean();
  void SmoothCovariance();
  /// smoothed_, which goes on from `folded_`, in the joint parameters of `filtered`.
  void Unfold(const Belief& filtered);

  MotionModel motion_model_;
  JointLimitTransform transform_;
  RootParameters root_;
  Belief smoothed_;
  Belief folded_;     // the filtered belief, as the filter's prediction starts from it
  Belief predicted_;  // the next frame
  Eigen::VectorXd difference_;
  Eigen::VectorXd dx_;
  PaddedMatrix P_;          // of the prediction, then its root
  PaddedMatrix L_inverse_;  // transposed
  PaddedMatrix A_;
  PaddedMatrix S_;
  PaddedMatrix AS_;
  PaddedMatrix result_;
  MotionModel::Step step_;
  CoordinateMaps F_inverse_;
  int n_;  // states without rates
};

}  // namespace mmm_converter::s2kf
