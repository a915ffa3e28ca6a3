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

/// What was found later and is to be looked at.
void AddDoubt(std::string reason, Verdict* verdict);

/// "good", "check" or "failed".
const char* Name(Verdict::Level level);

/// @throws Error for another text.
Verdict::Level ParseVerdictLevel(const std::string& text);

/// As one line: "check: REASON; REASON".
std::string DescribeVerdict(const Verdict& verdict);

}  // namespace mmm_converter
