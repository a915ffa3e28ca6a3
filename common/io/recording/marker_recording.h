// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/io/recording/recording.h"

namespace mmm_converter {

/// @throws Error where a program's rate is no frame rate [Hz]; before it makes a MarkerSequence.
void CheckFrameRate(double rate);

/// A recording of markers that a program has, in metres and z up, instead of a file. name: for
/// messages, and of the motion.
/// @throws Error where there are no markers, two have one label, a coordinate is infinite, or the
/// rate is no frame rate.
Recording MakeRecording(MarkerSequence markers, const std::string& name);

}  // namespace mmm_converter
