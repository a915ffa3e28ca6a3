// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/support/warnings.h"

namespace mmm_converter {

/// Levels that --log takes.
inline constexpr const char* kLogLevels = "off, error, warning, info or debug";

/// Sends the log to stderr. level: one of kLogLevels.
/// @throws UsageError for another level.
void StartLog(const std::string& level);

void LogError(const std::string& message);
void LogWarning(const std::string& message);
/// Each of them. @see LogWarning
void LogWarnings(const Warnings& warnings);
void LogInfo(const std::string& message);

}  // namespace mmm_converter
