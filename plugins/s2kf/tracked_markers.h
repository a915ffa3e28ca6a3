// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/convert/tracking_setup.h"
#include "common/model/marker_kinematics.h"

namespace mmm_converter::s2kf {

/// The markers that are tracked, in the order of the assignments: where the model has them, which
/// label of a frame is theirs, how noisy they are. Immutable.
class TrackedMarkers {
 public:
  explicit TrackedMarkers(const TrackingSetup& setup);

  const MarkerKinematics& kinematics() const { return kinematics_; }
  /// Factor on a marker's standard deviation.
  const Eigen::VectorXd& noise_scale() const { return noise_scale_; }

  /// Of each coordinate of a marker's place on the person, NaN where that was not estimated [m].
  const Eigen::VectorXd& place_deviation() const { return place_deviation_; }

  /// Of each coordinate about that place, from frame to frame, NaN where that was not measured [m].
  const Eigen::VectorXd& skin_deviation() const { return skin_deviation_; }

  /// noise_scale() times how much quieter the person's marker was measured to be than the
  /// configured standard deviation [m], which goes for the others.
  Eigen::VectorXd FilterScale(double configured) const;

  /// measured: the markers in a frame of labels, 3 x markers [m]; all NaN where not seen. Returns
  /// how many are seen.
  int Gather(const Eigen::Ref<const Eigen::Matrix3Xd>& frame, Eigen::Matrix3Xd* measured) const;

 private:
  MarkerKinematics kinematics_;
  std::vector<LabelIx> labels_;
  Eigen::VectorXd noise_scale_;
  Eigen::VectorXd place_deviation_;
  Eigen::VectorXd skin_deviation_;  // NaN: not measured
};

}  // namespace mmm_converter::s2kf
