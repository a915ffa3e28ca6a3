// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "common/convert/motion_converter.h"

namespace mmm_converter {

/// @throws std::logic_error that says what the converter has given wrongly: a size that is not that
/// of the setup, a number that is not finite, a marker or a count that can't be.
void CheckEstimate(const FrameEstimate& estimate, const TrackingSetup& setup);

/// A plugin's factory and its converters, with everything that crosses the border checked: whatever
/// they throw, other than Error and std::bad_alloc, and whatever they give that can't be, becomes
/// an Error that names the plugin. file: of the plugin.
std::unique_ptr<MotionConverterFactory> WithChecks(std::unique_ptr<MotionConverterFactory> factory,
                                                   std::string file);

}  // namespace mmm_converter
