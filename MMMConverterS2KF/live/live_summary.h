// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "MMMConverterS2KF/live/live_run.h"
#include "MMMConverterS2KF/report/json.h"

namespace mmm_converter {

std::string FormatSummary(const LiveReport& report);

Json ToJson(const LiveReport& report);

}  // namespace mmm_converter
