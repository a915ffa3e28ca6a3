// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/convert/tracking_setup.h"
#include "common/fit/posture_fit.h"
#include "common/model/marker_kinematics.h"
#include "common/model/size_effects.h"

namespace mmm_converter::s2kf {

/// Where a person wears the markers, learnt from a recording.
struct WornPlaces {
  Eigen::Matrix3Xd offset;  ///< from the model's places, link axes [m]
  Eigen::VectorXd
      deviation;  ///< of each coordinate about them, from frame to frame [m]; NaN: unknown
};

/// The markers that are tracked, in the order of the assignments: where the model has them, which
/// label of a frame is theirs, how noisy they are. Immutable.
class TrackedMarkers {
 public:
  explicit TrackedMarkers(const TrackingSetup& setup);

  /// The same, worn at these places.
  TrackedMarkers Worn(const WornPlaces& places) const;

  const MarkerKinematics& kinematics() const { return kinematics_; }
  /// By marker, the one at that place of the other side of the body; -1: none.
  const std::vector<int>& mirror() const { return mirror_; }
  /// Of a frame, the column that is a marker's.
  LabelIx label(int m) const { return labels_[m]; }
  /// Joints that are drawn to a value.
  const std::vector<JointPull>& pulls() const { return pulls_; }
  /// Factor on a marker's standard deviation.
  const Eigen::VectorXd& noise_scale() const { return noise_scale_; }

  /// Of each coordinate of a marker's place on the person, NaN where that was not estimated [m].
  const Eigen::VectorXd& place_deviation() const { return place_deviation_; }

  /// Of each coordinate of a place that the posture by other markers told [m], 0 for others. Those
  /// of a link were told together and tell no more than one of them would.
  const Eigen::VectorXd& told_deviation() const { return told_deviation_; }

  /// Of each coordinate about that place, from frame to frame, NaN where that was not measured [m].
  const Eigen::VectorXd& skin_deviation() const { return skin_deviation_; }

  /// What a mean marker weighs in squares over one of noise scale 1, as a root; 1 where none has a
  /// scale of 1 or more and all are alike.
  double MeanTrust() const;

  /// noise_scale() times how much quieter the person's marker was measured to be than the
  /// configured standard deviation [m], which goes for the others.
  Eigen::VectorXd FilterScale(double configured) const;

  /// Of each coordinate of a marker, root mean square over the markers, each at least the
  /// configured standard deviation [m]: the model's lengths are not the person's, and a marker that
  /// was learnt beside its place moves there with the posture.
  double UsualDeviation(double configured) const;

  /// How sizes that are not the person's move the markers: of a person who was not calibrated, on a
  /// model of OpenSim, which is as large as its file has it.
  const SizeEffects& size_effects() const { return size_effects_; }

  /// measured: the markers in a frame of labels, 3 x markers [m]; all NaN where not seen. Returns
  /// how many are seen.
  int Gather(const Eigen::Ref<const Eigen::Matrix3Xd>& frame, Eigen::Matrix3Xd* measured) const;

 private:
  MarkerKinematics kinematics_;
  std::vector<int> mirror_;
  std::vector<LabelIx> labels_;
  std::vector<JointPull> pulls_;
  Eigen::VectorXd noise_scale_;
  Eigen::VectorXd place_deviation_;
  Eigen::VectorXd told_deviation_;
  Eigen::VectorXd skin_deviation_;  // NaN: not measured
  SizeEffects size_effects_;
  Eigen::VectorXd worn_deviation_;  // WornPlaces; NaN: not learnt
};

}  // namespace mmm_converter::s2kf
