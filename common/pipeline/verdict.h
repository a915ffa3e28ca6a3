// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace mmm_converter {

/// How far a motion, or a calibrated person, can be trusted.
struct Verdict {
  enum class Level {
    kGood,    ///< nothing speaks against it
    kCheck,   ///< someone has to look at it
    kFailed,  ///< it is not the person's
  };
  Level level = Level::kGood;
  std::vector<std::string> reasons;  ///< in words and numbers, the gravest first; good: none
};

/// "good", "check" or "failed".
const char* Name(Verdict::Level level);

/// @throws Error for another text.
Verdict::Level ParseVerdictLevel(const std::string& text);

/// As one line: "check: REASON; REASON".
std::string DescribeVerdict(const Verdict& verdict);

struct ConversionReport;

/// By what the recording's markers, the person and the track are, beside what right recordings
/// have; verdict.cc has the limits. The report's own verdict does not count.
Verdict JudgeConversion(const ConversionReport& report);

struct CalibrationReport;
struct ConverterConfig;

/// Likewise by what was estimated. config: what the person is scaled by.
Verdict JudgeCalibration(const CalibrationReport& report, const ConverterConfig& config);

struct LabelReport;

/// Likewise of names that were found; label_verdict.cc has the limits.
Verdict JudgeLabels(const LabelReport& report);

}  // namespace mmm_converter
