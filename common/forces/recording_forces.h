// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/forces/plate_forces.h"
#include "common/io/recording/recording.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// The forces of a recording's file where its markers are: in metres and with its time, z up.
/// Nothing: the file holds none.
/// @throws Error as ReadForces.
RecordedForces ForcesOf(const Recording& recording, Warnings* warnings);

/// Forces of another file (ReadExternalLoads), which has the axes and the time of the recording's.
/// @throws Error as ReadExternalLoads.
RecordedForces ForcesOf(const std::string& file, const Recording& recording, Warnings* warnings);

/// W becomes the frame that R turns it into.
void Turn(const Eigen::Matrix3d& R, RecordedForces* forces);

}  // namespace mmm_converter
