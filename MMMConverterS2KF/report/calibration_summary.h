// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "MMMConverterS2KF/conversion/person_calibration.h"

namespace mmm_converter {

/// What a subject has changed and how well it is determined, in a few lines, for people.
std::string FormatSubjectSummary(const Subject& subject);

/// A calibration in a dozen lines; the last is a sentence. file: the subject's.
std::string FormatCalibrationSummary(const CalibrationReport& report, const std::string& file);

/// Its figures as JSON: frames, iterations, distance_before_mm and distance_after_mm.
std::string FormatCalibrationFigures(const CalibrationResult& result);

/// A calibration as JSON; the README says what is in it.
std::string FormatCalibrationJson(const CalibrationReport& report, const std::string& file);

}  // namespace mmm_converter
