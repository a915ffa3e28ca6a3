// SPDX-License-Identifier: MIT
#include "plugins/s2kf/tracked_markers.h"

#include <limits>

namespace mmm_converter::s2kf {

using Eigen::Matrix3Xd;
using Eigen::Ref;

TrackedMarkers::TrackedMarkers(const TrackingSetup& setup)
    : kinematics_(*setup.model, setup.joints, MarkerIndices(setup.assignments())),
      labels_(LabelIndices(setup.assignments())),
      noise_scale_(NoiseScales(setup.assignments())),
      place_deviation_(noise_scale_.size()) {
  for (Eigen::Index m = 0; m < place_deviation_.size(); ++m) {
    const ModelMarker& marker = setup.model->markers()[kinematics_.markers()[m]];
    place_deviation_[m] = marker.deviation.value_or(std::numeric_limits<double>::quiet_NaN());
  }
}

int TrackedMarkers::Gather(const Ref<const Matrix3Xd>& frame, Matrix3Xd* measured) const {
  int seen = 0;
  for (std::size_t i = 0; i < labels_.size(); ++i) {
    auto marker = measured->col(static_cast<Eigen::Index>(i));
    marker = frame.col(labels_[i]);
    if (marker.allFinite()) {
      ++seen;
    } else {
      marker.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }
  return seen;
}

}  // namespace mmm_converter::s2kf
