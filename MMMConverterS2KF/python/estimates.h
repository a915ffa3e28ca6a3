// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "common/convert/motion_converter.h"

namespace mmm_converter::python {

/// A frame's estimate as the package's Estimate takes it, but for joint_names.
pybind11::dict EstimateDict(const TrackingSetup& setup, const FrameEstimate& estimate);

std::vector<std::string> TrackedJoints(const TrackingSetup& setup);

/// Of the markers that are tracked. labels: of the frames.
std::vector<std::string> UsedLabels(const TrackingSetup& setup,
                                    const std::vector<std::string>& labels);

}  // namespace mmm_converter::python
