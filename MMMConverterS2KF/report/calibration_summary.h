// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "MMMConverterS2KF/report/json.h"
#include "common/pipeline/person_calibration.h"

namespace mmm_converter {

/// What a subject has changed and how well it is determined, in a few lines, for people.
std::string FormatSubjectSummary(const Subject& subject);

/// A line for each recording: how many frames of it the person was estimated from.
std::string FormatTakenFrames(const std::vector<CalibrationInput>& recordings,
                              const Subject& subject);

/// A calibration in a dozen lines; the last is a sentence. file: the subject's.
std::string FormatCalibrationSummary(const CalibrationReport& report, const std::string& file);

/// The same as JSON; README.md says what is in it.
Json ToJson(const CalibrationReport& report, const std::string& file);

/// Frames, iterations, distance_before_mm and distance_after_mm.
Json ToJson(const CalibrationResult& result);

}  // namespace mmm_converter
