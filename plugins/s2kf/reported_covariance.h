// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "common/math/padded_matrix.h"
#include "common/model/marker_kinematics.h"
#include "plugins/s2kf/s2kf_settings.h"
#include "plugins/s2kf/tracked_markers.h"

namespace mmm_converter::s2kf {

/// How sure an estimate is, which the covariance of a filter with white noise does not tell: a
/// marker sits beside the model's place throughout a session, its soft tissue moves slowly, lengths
/// of segments are others, and none of that averages out over frames. The covariance is therefore
/// that of one look at the markers,
///   P = A (J^T C^-1 J + N S N) A,   A = (J^T C^-1 J + N)^-1,
/// with J the Jacobian at the estimate, C the variance of a marker's place, measured by the
/// residuals of those whose place no posture told; N what draws the estimate to the natural
/// posture, S how far joints are from that. Joints are angles in halves of their range, so that a
/// limit is no certainty. On a model that is as large as its file has it, sizes of its parts,
/// each off by its deviation, move the markers by U, and the residuals tell f of their variance:
///   P += f B B^T,   B = A J^T C^-1 U.
///
/// Frame by frame: Look, then Compute where it is due. Nothing is allocated after construction.
class ReportedCovariance {
 public:
  /// markers must outlive the object.
  ReportedCovariance(const TrackedMarkers& markers, const S2kfSettings& settings);

  /// Another recording.
  void Restart();

  /// Takes in the frame dt [s] after the last. z: 3 x markers [m], NaN = not seen or wrong; at: the
  /// estimate's markers and links.
  void Look(const Eigen::Matrix3Xd& z, const MarkerJacobian& at, double dt);

  /// Whether deviations, which change slowly, are to be computed for the latest frame.
  bool IsDue() const;

  ///  - angles: of the estimate [rad]; at: its markers and links, gets its Jacobian.
  ///  - own: what the estimator, which averages white noise, leaves of it; as deviations().
  ///  - until_look: nullptr, or per marker the time until it is seen next [s].
  void Compute(const Eigen::VectorXd& angles, const Eigen::VectorXd& own, MarkerJacobian* at,
               const Eigen::VectorXd* until_look = nullptr);

  /// The latest computed, of [root position; root rotation; joint angles], num_dofs [m, rad].
  const Eigen::VectorXd& deviations() const { return deviations_; }

  /// The latest computed, of the same; the squares of the deviations are its diagonal.
  Eigen::MatrixXd Covariance() const;

  /// Variance of a marker's place, each coordinate, at noise scale 1: what is constant or slow, and
  /// white noise [m^2].
  double slow_variance() const { return slow_; }
  double white_variance() const { return white_; }

 private:
  double PriorVariance(const S2kfSettings& settings) const;
  void EstimateVariances();
  /// What sizes that are not the person's add to the covariance, and to the residuals.
  void AddSizes(const MarkerJacobian& at);
  void EstimateSizeVariance(const MarkerJacobian& at);
  void Invert(const Eigen::VectorXd* until_look, const MarkerJacobian& at);
  /// The mean share of one look's white noise that an estimator leaves.
  double ShareOf(const Eigen::VectorXd& own) const;
  /// A marker that it moves is seen now.
  bool IsShown(int joint) const;
  double VarianceOf(int i, const Eigen::VectorXd& angles) const;

  const MarkerKinematics& kinematics_;
  const Eigen::VectorXd& place_deviation_;
  const Eigen::VectorXd& told_deviation_;
  int num_own_;  // markers whose places no posture told
  const Eigen::VectorXd& noise_scale_;
  const SizeEffects& size_effects_;
  DeviationSettings settings_;
  double look_variance_;    // that the filter's natural pull is meant for [m^2]
  double filter_variance_;  // of a marker, that the filter goes by, at noise scale 1 [m^2]
  double prior_variance_;   // of markers' places before any residual was seen [m^2]
  double clip_;             // a farther marker is a wrong one [m]
  Eigen::VectorXd unit_;    // of each state: 1, or half the range of a joint
  Eigen::VectorXd middle_;  // of the joints' ranges
  Eigen::VectorXd spread_;  // S: of joints about the natural posture, squared, in these units

  // Of the recording:
  Eigen::Matrix3Xd last_residual_;  // link axes, over the noise scale; NaN: not seen
  Eigen::VectorXd age_;             // since the last look [s]
  int frames_ = 0;
  double since_compute_ = 0;  // [s]
  double squares_ = 0;        // running means: of residuals, a frame
  double seen_ = 0;           // coordinates, a frame
  double step_squares_ = 0;   // of halves of squared differences of successive residuals
  double steps_ = 0;          // coordinates, a frame
  double fitted_ = 0;         // coordinates that the posture takes up
  double slow_ = 0;
  double white_ = 0;
  double white_share_ = 1;  // of it that the estimator left the last time

  Eigen::VectorXd deviations_;
  double variance_ = 0;   // mean of C, were all markers seen [m^2]
  Eigen::VectorXd pull_;  // N, of the joints
  PaddedMatrix weights_;  // C^-1
  PaddedMatrix H_;
  PaddedMatrix root_;
  PaddedMatrix A_;
  // Of sizes: what they move markers by, the same weighted, what the posture takes up of it, what
  // residuals keep (effects x coordinates), and the square of that.
  PaddedMatrix moved_, weighted_, taken_, of_sizes_, kept_, kept_square_;
  Eigen::VectorXd kept_residual_;
  double size_variance_ = 1;  // over that of SizeDeviations
  double size_looks_ = 0;
  double size_squares_ = 0;  // of residuals that sizes leave
};

}  // namespace mmm_converter::s2kf
