// SPDX-License-Identifier: MIT
#include "common/model/joint_limits.h"

#include <utility>

namespace mmm_converter {

KinematicModel WithUpperLimit(const KinematicModel& model, int joint, double upper) {
  ModelDescription description = DescriptionOf(model);
  for (Segment& segment : description.segments) {
    if (segment.joint == joint) segment.upper = upper;
  }
  return KinematicModel(std::move(description));
}

}  // namespace mmm_converter
