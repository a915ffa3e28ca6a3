// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/io/osim/osim_edit.h"

namespace mmm_converter {

/// A force that acts along a path.
struct OsimPath {
  XmlPlace force;
  double length = 0;  ///< straight from point to point, at the default posture [m]
  bool wraps = false;
};

/// Of all forces of the model, in its order, with the points that are active at the default
/// posture. They are valid as long as `edit`.
std::vector<OsimPath> MeasureOsimPaths(OsimEdit* edit);

/// The points of a force's path; none: it has no path.
std::vector<XmlPlace> OsimPathPoints(const XmlPlace& force);

}  // namespace mmm_converter
