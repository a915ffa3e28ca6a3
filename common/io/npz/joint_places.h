// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/io/npz/numpy_array.h"
#include "common/motion/recording_content.h"
#include "common/support/warnings.h"

namespace mmm_converter {

inline constexpr double kFarthestJoint = 1e6;  ///< a coordinate that means anything

/// Places of joints, frames x joints x 3, in the order of SMPL's or of LAFAN1's, whose bones tell
/// which it is. rate: 0: the file does not say.
/// @throws Error where the array is none of such places.
RecordingContent ContentOfPlaces(NumpyArray places, double rate, const std::string& file,
                                 Warnings* warnings);

}  // namespace mmm_converter
