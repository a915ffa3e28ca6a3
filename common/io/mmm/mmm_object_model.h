// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/model/kinematic_model.h"

namespace mmm_converter {

/// The file of a rigid object's model, as ReadMmmModel reads it: its name, one node and its
/// markers, whose places have 4 decimals of a millimetre. comment: stands before the root; may be
/// empty.
std::string FormatObjectModel(const KinematicModel& model, const std::string& comment);

}  // namespace mmm_converter
