// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "plugins/s2kf/gaussian_update.h"

namespace mmm_converter::s2kf {

/// What one update of MarkerFilter leaves behind: where the prediction had the markers, how sure it
/// was, how much each counted, and what the posterior says of them. A value: the filter keeps none
/// of it. Markers and states are those of the filter; places in W [m].
struct UpdateOutcome {
  /// Sized once, for as many states as kinematics.num_dofs().
  UpdateOutcome(int num_dofs, int num_markers);

  int seen = 0;
  int downweighted = 0;       ///< seen, but so far from the estimate that they count less
  double nis = 0;             ///< of the first pass, over its degrees of freedom
  double log_likelihood = 0;  ///< of z in the first pass, GaussianUpdate::log_likelihood

  /// R of each marker's coordinates [m^2], greater where the marker was downweighted. A marker that
  /// is not seen has that of one where it is expected.
  Eigen::VectorXd variance;
  MeasurementMoments moments;  ///< of all markers' places, about the last linearisation
  GaussianUpdate update;       ///< by z and `variance`; the prior where nothing was seen

  /// E[z] before the update, 3 x markers. All markers, seen or not.
  Eigen::Map<const Eigen::Matrix3Xd> Expected() const;
  /// Cov of a marker's place before the update [m^2].
  Eigen::Matrix3d ExpectedCovariance(int marker) const;
  /// Cov(z - E[z]) of a marker [m^2]: ExpectedCovariance + variance.
  Eigen::Matrix3d InnovationCovariance(int marker) const;

  /// Where the update would have left the markers, had these places been measured instead of z, by
  /// the same markers; stacked, 3 markers.
  void PosteriorPlaces(const Eigen::VectorXd& measured, GaussianUpdate::Scratch* scratch,
                       Eigen::VectorXd* places) const {
    update.Expect(moments, measured, scratch, places);
  }
  /// Cov of a marker's place after the update [m^2].
  Eigen::Matrix3d PosteriorCovariance(int marker, GaussianUpdate::Scratch* scratch) const {
    return update.PosteriorCovariance(moments.C_sz, 3 * marker, scratch);
  }
};

}  // namespace mmm_converter::s2kf
