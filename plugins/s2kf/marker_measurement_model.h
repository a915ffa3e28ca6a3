// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "common/math/padded_matrix.h"
#include "common/model/marker_kinematics.h"
#include "plugins/s2kf/belief.h"
#include "plugins/s2kf/gaussian_update.h"
#include "plugins/s2kf/joint_limit_transform.h"
#include "plugins/s2kf/sample_kernels.h"

namespace mmm_converter::s2kf {

/// A root S of a covariance S S^T, n x n.
struct SpreadRoot {
  const PaddedMatrix& matrix;
  bool is_lower = false;  ///< triangular: half the work
};

/// z = h(x): where the model's markers are, by forward kinematics behind the limit transform.
/// Gives the moments of h for x = belief moved by L (mu + T s), s ~ N(0, I), from point-symmetric
/// samples or from the analytic Jacobian (EKF). Owns all scratch; one per thread, sized once.
class MarkerMeasurementModel {
 public:
  /// half_samples: n x K, of the standard normal in n = kinematics.num_dofs() dimensions; the whole
  /// set is these, their negatives and 0, equally weighted (lcd_sampling.h). Empty: analytic
  /// Jacobian. kinematics must outlive the model.
  MarkerMeasurementModel(const MarkerKinematics& kinematics, JointLimitTransform transform,
                         RootParameters root, const Eigen::MatrixXd& half_samples);

  int num_states() const { return kinematics_.num_dofs(); }
  int num_coordinates() const { return 3 * kinematics_.num_markers(); }
  const JointLimitTransform& transform() const { return transform_; }

  /// Moments of h about belief moved by `center`, spread by `spread`. with_covariance: fill C_zz
  /// too.
  void ComputeMoments(const Belief& belief, const Eigen::VectorXd& center, const SpreadRoot& spread,
                      bool with_covariance, MeasurementMoments* moments);

 private:
  void ComputeSampled(const Belief& belief, const Eigen::VectorXd& center, const SpreadRoot& spread,
                      bool with_covariance, MeasurementMoments* moments);
  void ComputeLinearized(const Belief& belief, const Eigen::VectorXd& center,
                         const SpreadRoot& spread, bool with_covariance,
                         MeasurementMoments* moments);
  void PlaceRoots(const Belief& belief, const Eigen::VectorXd& center);
  void PlaceAngles(const Belief& belief, const Eigen::VectorXd& center);

  const MarkerKinematics& kinematics_;
  JointLimitTransform transform_;
  RootParameters root_;
  const SampleKernels& kernels_;
  int num_pairs_;
  int rows_;                   // of one half: pairs, the centre, padding
  PaddedMatrix half_samples_;  // n x rows_: half samples, then zeros
  PaddedMatrix samples_;       // the same transposed
  PaddedMatrix offsets_;       // rows_ x n: samples_ * spread^T
  MarkerBatch batch_;          // first half: centre + offset, second half: centre - offset
  PaddedMatrix parts_;         // m x 2 rows_: odd and even parts of z, for the covariance
  PaddedMatrix mean_of_even_;  // m x 1
  MarkerJacobian at_;
  Eigen::VectorXd angles_;
  Eigen::VectorXd slopes_;
  PaddedMatrix spread_transposed_;
};

}  // namespace mmm_converter::s2kf
