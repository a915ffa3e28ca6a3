// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "common/convert/tracking_setup.h"
#include "common/label/search/label_body.h"
#include "tests/support/synthetic_person.h"

namespace mmm_converter::testing {

/// The scaled reference model itself as a person, its markers where it has them: truth is exact but
/// for skin (4 mm). Marker m of the body is label m.
struct MadePerson {
  explicit MadePerson(std::uint64_t seed, double seconds = 0.2)
      : model(ScaledReferenceModel(1.75)),
        motion(RangeOfMotion(model, seconds, 0.6, seed)),
        recording(RecordPerson(model, motion, seed)),
        setup(SetupOf(model, TrackedJoints(model), AssignAll(model, recording))),
        body(setup) {}

  /// The posture of a frame; tracked joints, in the body's order.
  const Posture& PostureAt(int k) const { return motion.postures[k]; }

  /// The markers of a frame, in the order of the body's.
  Eigen::Matrix3Xd PointsAt(int k) const {
    Eigen::Matrix3Xd points(3, body.num_markers());
    for (int m = 0; m < body.num_markers(); ++m) {
      points.col(m) = recording.frame(k).col(setup.assignments()[m].label);
    }
    return points;
  }

  KinematicModel model;
  PoseTrajectory motion;
  MarkerSequence recording;
  TrackingSetup setup;
  LabelBody body;
};

/// How many markers have their own point, where point m is marker m.
inline int CountOwn(const std::vector<int>& point_of_marker) {
  int own = 0;
  for (std::size_t m = 0; m < point_of_marker.size(); ++m) {
    own += point_of_marker[m] == static_cast<int>(m) ? 1 : 0;
  }
  return own;
}

}  // namespace mmm_converter::testing
