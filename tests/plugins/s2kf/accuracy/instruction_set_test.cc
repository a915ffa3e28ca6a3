// SPDX-License-Identifier: MIT
// The instruction set is chosen once a process, so a process of its own tracks with each.
#include "common/math/instruction_set.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace mmm_converter::s2kf {
namespace {

/// The text that track_sample writes.
std::string Track(const std::string& method, InstructionSet set) {
  const std::string command = "MMM_CONVERTER_INSTRUCTION_SET=" + ToString(set) +
                              " '" MMM_CONVERTER_BINARY_DIR "/tests/track_sample' " + method;
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string text;
  char buffer[4096];
  while (const std::size_t size = std::fread(buffer, 1, sizeof buffer, pipe.get())) {
    text.append(buffer, size);
  }
  return text;
}

std::vector<double> Numbers(const std::string& text) {
  std::vector<double> numbers;
  const char* next = text.c_str();
  char* end = nullptr;
  for (double x = std::strtod(next, &end); end != next; x = std::strtod(next, &end)) {
    numbers.push_back(x);
    next = end;
  }
  return numbers;
}

class InstructionSetTest : public ::testing::TestWithParam<const char*> {};

TEST_P(InstructionSetTest, AllTrackTheSameAndEachTheSameEveryTime) {
  const std::string baseline_text = Track(GetParam(), InstructionSet::kBaseline);
  const std::vector<double> baseline = Numbers(baseline_text);
  ASSERT_EQ(baseline.size(), 200 * 53 * 3);
  for (const InstructionSet set : SupportedInstructionSets()) {
    const std::string text = Track(GetParam(), set);
    EXPECT_EQ(text, Track(GetParam(), set)) << ToString(set);
    const std::vector<double> numbers = Numbers(text);
    ASSERT_EQ(numbers.size(), baseline.size());
    double largest = 0;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      largest = std::max(largest, std::abs(numbers[i] - baseline[i]));
    }
    std::printf("[ measured ] %s, %s: at most %.1e m from the baseline\n", GetParam(),
                ToString(set).c_str(), largest);
    EXPECT_LT(largest, 1e-9) << ToString(set);
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, InstructionSetTest,
                         ::testing::Values("s2kf-regression", "s2kf-exact", "ekf", "fit"));

}  // namespace
}  // namespace mmm_converter::s2kf
