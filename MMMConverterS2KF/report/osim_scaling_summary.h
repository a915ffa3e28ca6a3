// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "MMMConverterS2KF/report/json.h"
#include "common/pipeline/osim_scaling_run.h"

namespace mmm_converter {

/// Factors of the bodies, mass and markers, for people; the last line is a sentence, and of a
/// calibration its verdict. file: the model that was written.
std::string FormatOsimScalingSummary(const OsimScalingReport& report, const std::string& file);

Json ToJson(const OsimScalingReport& report, const std::string& file);

}  // namespace mmm_converter
