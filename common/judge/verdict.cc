// SPDX-License-Identifier: MIT
#include "common/judge/verdict.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

using Level = Verdict::Level;

constexpr const char* kLevelNames[] = {"good", "check", "failed"};

}  // namespace

const char* Name(Verdict::Level level) { return kLevelNames[static_cast<int>(level)]; }

Verdict::Level ParseVerdictLevel(const std::string& text) {
  for (const Level level : {Level::kGood, Level::kCheck, Level::kFailed}) {
    if (text == Name(level)) return level;
  }
  throw Error(fmt::format("unknown verdict \"{}\"; good, check or failed", text));
}

std::string DescribeVerdict(const Verdict& verdict) {
  std::string text = Name(verdict.level);
  if (!verdict.reasons.empty()) text += fmt::format(": {}", fmt::join(verdict.reasons, "; "));
  return text;
}

}  // namespace mmm_converter
