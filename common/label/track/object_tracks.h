// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "common/label/track/track_names.h"

namespace mmm_converter {

/// A rigid object whose shape is known.
struct LabelObject {
  std::vector<int> names;  ///< of its markers
  Eigen::Matrix3Xd p_OM;   ///< their places, 3 x markers [m]: three or more, not on a line
};

/// The tracks that are objects' markers for more than half of their frames. Markers are counted
/// from first_marker on, over all objects in order. at_frame(frame) is called for each; it may
/// throw.
TrackNames FindObjectTracks(const std::vector<LabelObject>& objects, const PointTracks& tracks,
                            int first_marker, const std::function<void(int)>& at_frame);

}  // namespace mmm_converter
