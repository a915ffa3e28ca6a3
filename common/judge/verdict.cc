// SPDX-License-Identifier: MIT
#include "common/judge/verdict.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

using Level = Verdict::Level;

constexpr const char* kLevelNames[] = {"good", "check", "failed"};

}  // namespace

void AddDoubt(std::string reason, Verdict* verdict) {
  verdict->level = std::max(verdict->level, Verdict::Level::kCheck);
  verdict->reasons.push_back(std::move(reason));
}

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
