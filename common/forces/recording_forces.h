// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/forces/plate_forces.h"
#include "common/io/recording/recording.h"
#include "common/math/up_axis.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// The forces of a recording's file where its markers are: in metres and with its time, z up.
/// Nothing: the file holds none.
/// @throws Error as ReadForces.
RecordedForces ForcesOf(const Recording& recording, Warnings* warnings);

/// Forces of another file (ReadExternalLoads), whose up axis is that of the recording's file, or
/// y where its forces say so, and which has its time. @throws Error as ReadExternalLoads.
RecordedForces ForcesOf(const std::string& file, UpAxis up, Warnings* warnings);

}  // namespace mmm_converter
