// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "common/kinetics/joint_forces.h"

namespace mmm_converter {

/// Standard deviations of what moments are computed from, beside postures.
struct ForceErrors {
  /// Of each segment's mass and inertia, as a part of them: tables of segments differ by about that
  /// (de Leva, "Adjustments to Zatsiorsky-Seluyanov's segment inertia parameters", 1996).
  double mass = 0.1;
  double center_of_pressure = 0.005;  ///< along x and y, of each foot [m]
};

/// Fills found->deviations, to first order. Errors of postures last for a step (covariances: of
/// `motion`, by frame; each until the next), and are white besides, which accelerations feel: as
/// much as the low-pass takes away tells how white. Computed twenty times a second, and linear
/// between. The arguments are those of ComputeJointForces. covariances: not empty.
void EstimateDeviations(const KinematicModel& model, const PoseTrajectory& motion,
                        const Contacts& contacts, const RecordedForces& forces,
                        const std::vector<PoseCovariance>& covariances, const ForceErrors& errors,
                        JointForces* found);

}  // namespace mmm_converter
