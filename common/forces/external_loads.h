// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/forces/plate_forces.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// Forces as OpenSim has them: a table (.mot, .sto) of forces [N], points [m] and torques [N m], or
/// the ExternalLoads XML that names it and says which body each force acts on. W: the file's axes;
/// up: the one of them that points up. Each force is a plate without a known outline. Without XML
/// the columns tell: PREFIXvx to vz, PREFIXpx to pz, and of the torque what differs by "torque" in
/// place of "force".
/// @throws Error where there is no force, columns are missing, or times are not even.
RecordedForces ReadExternalLoads(const std::string& path, const Eigen::Vector3d& up,
                                 Warnings* warnings);

}  // namespace mmm_converter
