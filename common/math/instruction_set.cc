// SPDX-License-Identifier: MIT
#include "common/math/instruction_set.h"

#include <fmt/core.h>

#include <cstdlib>

#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr char kVariable[] = "MMM_CONVERTER_INSTRUCTION_SET";

InstructionSet Choose() {
  const std::vector<InstructionSet> supported = SupportedInstructionSets();
  const char* wish = std::getenv(kVariable);
  if (wish == nullptr || *wish == '\0') return supported.back();
  std::vector<std::string> names;
  for (const InstructionSet set : supported) {
    if (ToString(set) == wish) return set;
    names.push_back(ToString(set));
  }
  throw Error(fmt::format("{}=\"{}\" is not possible on this processor; use {}", kVariable, wish,
                          JoinNames(names)));
}

}  // namespace

std::string ToString(InstructionSet set) {
  switch (set) {
    case InstructionSet::kBaseline:
      return "baseline";
    case InstructionSet::kAvx2:
      return "avx2";
    case InstructionSet::kAvx512:
      return "avx512";
  }
  return {};
}

std::vector<InstructionSet> SupportedInstructionSets() {
  std::vector<InstructionSet> sets = {InstructionSet::kBaseline};
#if defined(__x86_64__)
  // The rest of x86-64-v3 and v4 has always come with these.
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma") ||
      !__builtin_cpu_supports("bmi2")) {
    return sets;
  }
  sets.push_back(InstructionSet::kAvx2);
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl")) {
    sets.push_back(InstructionSet::kAvx512);
  }
#endif
  return sets;
}

InstructionSet ActiveInstructionSet() {
  static const InstructionSet active = Choose();
  return active;
}

}  // namespace mmm_converter
