// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include "common/convert/motion_converter.h"

namespace mmm_converter::python {

/// A frame's estimate as the package's Estimate takes it, but for joint_names.
pybind11::dict EstimateDict(const TrackingSetup& setup, const FrameEstimate& estimate);

}  // namespace mmm_converter::python
