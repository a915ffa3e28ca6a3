// SPDX-License-Identifier: MIT
#include "common/label/learn/marker_names.h"

#include <gtest/gtest.h>

namespace mmm_converter::testing {
namespace {

TEST(MarkerNamesTest, SidesAreNamedWhereTheOtherSideIsThereToo) {
  const std::vector<std::string> labels = {"LASI",      "RASI",       "L.Shoulder", "r_shoulder",
                                           "Left Knee", "RIGHT_KNEE", "HeelL",      "Heel.R",
                                           "L3",        "STRN",       "RBAK",       "LHD"};
  constexpr auto kL = NamedSide::kLeft, kR = NamedSide::kRight, kNo = NamedSide::kNone;
  const std::vector<NamedSide> expected = {kL, kR, kL, kR, kL, kR, kL, kR, kNo, kNo, kNo, kNo};
  EXPECT_EQ(NamedSides(labels), expected);
}

}  // namespace
}  // namespace mmm_converter::testing
