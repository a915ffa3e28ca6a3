// SPDX-License-Identifier: MIT
#include "plugins/s2kf/tracked_markers.h"

#include <algorithm>
#include <cmath>

#include "common/model/kit_joints.h"
#include "common/support/units.h"

namespace mmm_converter::s2kf {

using Eigen::Matrix3Xd;
using Eigen::Ref;

namespace {

// Of the configured deviation, at least: joints and lengths are not quite the person's, and a
// marker that alone shows a joint has no residual.
constexpr double kLeastShare = 0.2;

// Of a marker's place that is less known than where anybody wears one [m]: the posture told it.
constexpr double kOfAnybody = 0.028;

Eigen::VectorXd ToldDeviations(const TrackingSetup& setup, const MarkerKinematics& kinematics) {
  Eigen::VectorXd told = Eigen::VectorXd::Zero(kinematics.num_markers());
  for (Eigen::Index m = 0; m < told.size(); ++m) {
    const ModelMarker& marker = setup.model->markers()[kinematics.markers()[m]];
    const bool is_measured = marker.skin_deviation.has_value();
    if (!is_measured && marker.deviation.value_or(0) > kOfAnybody) told[m] = *marker.deviation;
  }
  if ((told.array() > 0).all()) return Eigen::VectorXd::Zero(told.size());  // there are no others
  Eigen::VectorXd all = told;
  for (Eigen::Index m = 0; m < told.size(); ++m) {
    int together = 0;
    for (Eigen::Index other = 0; other < told.size(); ++other) {
      const auto link = [&](Eigen::Index i) {
        return kinematics.link_of_marker(static_cast<int>(i));
      };
      together += told[other] > 0 && link(other) == link(m);
    }
    all[m] *= std::sqrt(together);
  }
  return all;
}

}  // namespace

TrackedMarkers::TrackedMarkers(const TrackingSetup& setup)
    : kinematics_(*setup.model, setup.joints, MarkerIndices(setup.assignments())),
      mirror_(MirroredMarkers(*setup.model, kinematics_.markers())),
      labels_(LabelIndices(setup.assignments())),
      pulls_(PullsOf(setup)),
      noise_scale_(NoiseScales(setup.assignments())),
      place_deviation_(noise_scale_.size()),
      told_deviation_(ToldDeviations(setup, kinematics_)),
      skin_deviation_(noise_scale_.size()),
      worn_deviation_(Eigen::VectorXd::Constant(noise_scale_.size(), kNaN)) {
  for (Eigen::Index m = 0; m < place_deviation_.size(); ++m) {
    const ModelMarker& marker = setup.model->markers()[kinematics_.markers()[m]];
    place_deviation_[m] = told_deviation_[m] > 0 ? kNaN : marker.deviation.value_or(kNaN);
    skin_deviation_[m] = marker.skin_deviation.value_or(kNaN);
  }
  if (setup.model->coordinates() != nullptr && place_deviation_.array().isNaN().all()) {
    size_effects_ = SizeEffects(*setup.model, kinematics_, {});
  }
}

TrackedMarkers TrackedMarkers::Worn(const WornPlaces& places) const {
  TrackedMarkers worn = *this;
  worn.kinematics_ = kinematics_.WithMarkersMoved(places.offset);
  worn.worn_deviation_ = places.deviation;
  return worn;
}

double TrackedMarkers::MeanTrust() const {
  return std::min(1.0, noise_scale_.maxCoeff()) *
         std::sqrt(noise_scale_.cwiseAbs2().cwiseInverse().mean());
}

Eigen::VectorXd TrackedMarkers::FilterScale(double configured) const {
  // Well known places weigh more than others, yet the skin about them, and what samples leave
  // unexplained in quick motion, are no smaller: three quarters of the way, as a power, a mean
  // marker weighs as one of scale 1 (85_02 is lost in 15 % of its frames without, in 2 % so).
  const double trust = MeanTrust();
  Eigen::VectorXd scale = std::max(1.0, std::pow(trust, 0.75)) * noise_scale_;
  for (Eigen::Index m = 0; m < scale.size(); ++m) {
    if (std::isnan(skin_deviation_[m])) continue;
    scale[m] *= std::clamp(skin_deviation_[m] / configured, kLeastShare, 1.0);
  }
  return scale;
}

double TrackedMarkers::UsualDeviation(double configured) const {
  const auto known = worn_deviation_.array().isNaN().select(configured, worn_deviation_);
  return std::sqrt(known.array().max(configured).square().mean());
}

int TrackedMarkers::Gather(const Ref<const Matrix3Xd>& frame, Matrix3Xd* measured) const {
  int seen = 0;
  for (std::size_t i = 0; i < labels_.size(); ++i) {
    auto marker = measured->col(static_cast<Eigen::Index>(i));
    marker = frame.col(labels_[i]);
    if (marker.allFinite()) {
      ++seen;
    } else {
      marker.setConstant(kNaN);
    }
  }
  return seen;
}

}  // namespace mmm_converter::s2kf
