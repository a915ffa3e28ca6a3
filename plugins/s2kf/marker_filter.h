// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/fit/posture_fit.h"
#include "common/model/marker_kinematics.h"
#include "common/model/posture.h"
#include "plugins/s2kf/belief.h"
#include "plugins/s2kf/marker_measurement_model.h"
#include "plugins/s2kf/motion_model.h"
#include "plugins/s2kf/s2kf_settings.h"
#include "plugins/s2kf/update_outcome.h"

namespace mmm_converter::s2kf {

/// The Kalman filter on markers: belief in, belief out; what it holds is scratch and constants. One
/// code path for S2KF, UKF and EKF, which differ in how MarkerMeasurementModel takes its moments.
/// Postures hold the tracked joints of `kinematics`.
class MarkerFilter {
 public:
  /// noise_scale: factor on the marker standard deviation, per marker. pulls: each is one more
  /// measurement of its joint in every frame. kinematics must outlive the filter.
  MarkerFilter(const MarkerKinematics& kinematics, const S2kfSettings& settings,
               const Eigen::VectorXd& noise_scale, std::vector<JointPull> pulls = {});

  /// A belief about a fitted posture, with the spread that a fit leaves.
  void StartAt(const Posture& posture, Belief* belief) const;

  /// The paper's start [S15]: root at the mean of the seen markers with their covariance,
  /// orientation 0 with 1e-6 rad^2, joint parameters 0 with 1e-10.
  void StartAsPaper(const Eigen::Ref<const Eigen::Matrix3Xd>& z, Belief* belief) const;

  /// Folds the joint parameters (JointLimitTransform::Fold), moves on by dt, and pulls.
  void Predict(double dt, Belief* belief);

  /// What Update writes into, of the right sizes.
  UpdateOutcome MakeOutcome() const { return {kinematics_.num_dofs(), kinematics_.num_markers()}; }

  /// What Update of this belief does whatever the markers: kept until one of another belief, or
  /// Prepare. Changes no result.
  void Prepare(const Belief& prior);

  /// z: 3 x markers [m], NaN = not seen; such a marker is left out. Nothing seen: the belief stays.
  void Update(const Eigen::Ref<const Eigen::Matrix3Xd>& z, Belief* belief, UpdateOutcome* outcome);

  void ToPosture(const Belief& belief, Posture* posture) const;
  /// The posture, and its markers in at->p_WM.
  void Place(const Belief& belief, Posture* posture, MarkerJacobian* at) const;
  /// Standard deviations of [root position; root rotation; joint angles], num_dofs.
  void Deviations(const Belief& belief, Eigen::VectorXd* deviations) const;

  const MotionModel& motion_model() const { return motion_model_; }
  const JointLimitTransform& transform() const { return measurement_model_.transform(); }

 private:
  /// Takes z into z_, and sets noise_ by how far each marker is from expected_.
  void Weigh(const Eigen::Ref<const Eigen::Matrix3Xd>& z, UpdateOutcome* outcome);
  void Pull(const JointPull& pull, Belief* belief);
  void Rest(Belief* belief) const;
  void FactorizeCovariance(const Belief& belief);
  /// L_, and the moments about the belief.
  void Expect(const Belief& belief, MeasurementMoments* moments);
  /// The part of L_ for the states that h depends on, n x n.
  const PaddedMatrix& L_x() const { return motion_model_.velocity ? L_states_ : L_; }
  bool IsFarFromLinear(const MeasurementMoments& moments) const;
  void Relinearize(const Belief& belief, UpdateOutcome* outcome);
  void Commit(const GaussianUpdate& update, Belief* belief);

  const MarkerKinematics& kinematics_;
  S2kfSettings settings_;
  Eigen::VectorXd noise_scale_;
  std::vector<JointPull> pulls_;
  MotionModel motion_model_;
  std::vector<int> resting_;  // joints that move no marker
  MarkerMeasurementModel measurement_model_;
  Eigen::VectorXd expected_;  // of z, by the latest estimate
  Eigen::VectorXd z_;         // measured coordinates, m
  Eigen::VectorXd noise_;     // their variances, m; infinity: not seen
  PaddedMatrix C_sz_;         // scratch, n x m
  PaddedMatrix L_;            // root of P, lower triangular; n columns of n or, with rates, 2n rows
  PaddedMatrix L_rates_;      // its other n columns, with rates
  PaddedMatrix L_states_;     // its first n rows, with rates
  PaddedMatrix P_;
  PaddedMatrix posterior_;    // L_ T
  PaddedMatrix posterior_x_;  // L_x T
  Eigen::VectorXd center_;
  Eigen::VectorXd dx_;
  bool is_prepared_ = false;
  Belief prior_;
  MeasurementMoments prior_moments_;
};

}  // namespace mmm_converter::s2kf
