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

}  // namespace

TrackedMarkers::TrackedMarkers(const TrackingSetup& setup)
    : kinematics_(*setup.model, setup.joints, MarkerIndices(setup.assignments())),
      mirror_(MirroredMarkers(*setup.model, kinematics_.markers())),
      labels_(LabelIndices(setup.assignments())),
      pulls_(PullsOf(setup)),
      noise_scale_(NoiseScales(setup.assignments())),
      place_deviation_(noise_scale_.size()),
      skin_deviation_(noise_scale_.size()),
      worn_deviation_(Eigen::VectorXd::Constant(noise_scale_.size(), kNaN)) {
  for (Eigen::Index m = 0; m < place_deviation_.size(); ++m) {
    const ModelMarker& marker = setup.model->markers()[kinematics_.markers()[m]];
    place_deviation_[m] = marker.deviation.value_or(kNaN);
    skin_deviation_[m] = marker.skin_deviation.value_or(kNaN);
  }
}

TrackedMarkers TrackedMarkers::Worn(const WornPlaces& places) const {
  TrackedMarkers worn = *this;
  worn.kinematics_ = kinematics_.WithMarkersMoved(places.offset);
  worn.worn_deviation_ = places.deviation;
  return worn;
}

Eigen::VectorXd TrackedMarkers::FilterScale(double configured) const {
  Eigen::VectorXd scale = noise_scale_;
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
