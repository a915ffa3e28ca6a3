// SPDX-License-Identifier: MIT
#include "common/support/suggestion.h"

#include <gtest/gtest.h>

namespace mmm_converter {
namespace {

TEST(ClosestName, FindsMisspellingsOnly) {
  const std::vector<std::string> names = {"convert", "info", "print-config"};
  EXPECT_EQ(ClosestName("covnert", names), "convert");
  EXPECT_EQ(ClosestName("INFO", names), "info");
  EXPECT_EQ(ClosestName("print_config", names), "print-config");
  EXPECT_EQ(ClosestName("help", names), "");
  EXPECT_EQ(ClosestName("", names), "");
  EXPECT_EQ(ClosestName(std::string(100000, 'a'), names), "");
}

}  // namespace
}  // namespace mmm_converter
