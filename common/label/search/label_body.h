// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/convert/tracking_setup.h"
#include "common/model/marker_kinematics.h"
#include "common/model/posture.h"

namespace mmm_converter {

/// What labelling knows of a person: where the body can have the markers, and how far from there
/// they are worn and slide. Immutable.
struct LabelBody {
  /// One marker for each assignment of the setup.
  explicit LabelBody(const TrackingSetup& setup);

  int num_markers() const { return kinematics.num_markers(); }

  MarkerKinematics kinematics;
  Eigen::VectorXd place;  ///< deviation of a marker from the model's place, each coordinate [m]
  Eigen::VectorXd skin;   ///< deviation about its own place, each coordinate [m]
  Eigen::VectorXd natural_angles;  ///< NaturalAngles
  /// The tracked joints that move a marker, in their order.
  std::vector<std::vector<int>> joints_of_marker;
  /// What hangs on the trunk: joints that move at most a third of the markers, and the markers that
  /// they move.
  struct Limb {
    std::vector<int> joints, markers;
  };
  std::vector<Limb> limbs;
  std::vector<int> limb_of_marker;  ///< -1: the trunk
  /// Postures to start from, with the root at the origin and upright: arms and legs in several
  /// ways; of a model of OpenSim the one at rest.
  std::vector<Posture> templates;

 private:
  void FindLimbs();
};

}  // namespace mmm_converter
