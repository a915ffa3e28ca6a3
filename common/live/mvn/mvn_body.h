// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "common/live/mvn/mvn_packet.h"
#include "common/model/kinematic_model.h"
#include "common/model/posture.h"

namespace mmm_converter {

/// MVN's segments on the MMM model. A segment's origin is its proximal joint; in the T-pose all
/// axes are x forward, y left, z up. L3, T12 and T8, between which the model does not bend, are
/// parts of the thorax.
class MvnBody {
 public:
  /// @throws Error where the model lacks a segment: it is not MMM's.
  explicit MvnBody(const KinematicModel& model);

  MvnPoses Poses(const KinematicModel& model, const Posture& posture) const;

  /// Of the person who stands with arms raised to the side, looking along x, all axes the world's:
  /// the pelvis above the origin, the lowest segment's origin at z = 0.
  MvnPoses TPose(const KinematicModel& model) const;

 private:
  struct Part {
    int segment = -1;
    int toward = -1;  // the origin is so far on the way to this segment's
    double share = 0;
    Eigen::Quaterniond R_SA;  // MVN's axes in the segment's
  };
  std::array<Part, kMvnSegments> parts_;
};

}  // namespace mmm_converter
