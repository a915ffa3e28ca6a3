// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace mmm_converter {

/// How far a motion can be trusted.
struct Verdict {
  enum class Level {
    kGood,    ///< nothing speaks against it
    kCheck,   ///< someone has to look at it
    kFailed,  ///< it is not the person's motion
  };
  Level level = Level::kGood;
  std::vector<std::string> reasons;  ///< in words and numbers, the gravest first; good: none

  /// Adds a reason, before those of lower levels; the level is that of the gravest.
  void Add(Level reasons_level, std::string reason);

 private:
  std::size_t num_failed_ = 0;  // reasons of kFailed, which stand in front
};

/// "good", "check" or "failed".
const char* Name(Verdict::Level level);

/// @throws Error for another text.
Verdict::Level ParseVerdictLevel(const std::string& text);

/// As one line: "check: REASON; REASON".
std::string DescribeVerdict(const Verdict& verdict);

struct ConversionReport;

/// By what the recording's markers, the person and the track are, beside what right recordings
/// have. The report's own verdict does not count. README.md has the limits.
Verdict JudgeConversion(const ConversionReport& report);

}  // namespace mmm_converter
