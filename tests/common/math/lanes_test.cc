// SPDX-License-Identifier: MIT
#define MMM_CONVERTER_VARIANT lanes_test
#include "common/math/lanes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace mmm_converter::lanes_test {
namespace {

TEST(LanesTest, SinCosIsTheStandardLibrarysToTwoRoundings) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-20, 20);
  for (int i = 0; i < 20000; ++i) {
    Lanes x;
    for (int k = 0; k < kLanes; ++k) x[k] = uniform(random);
    Lanes sine;
    Lanes cosine;
    SinCos(x, &sine, &cosine);
    for (int k = 0; k < kLanes; ++k) {
      // The series ends below 3e-16, and adds one rounding of 1.1e-16 to the library's.
      ASSERT_NEAR(sine[k], std::sin(x[k]), 6e-16) << x[k];
      ASSERT_NEAR(cosine[k], std::cos(x[k]), 6e-16) << x[k];
    }
  }
}

}  // namespace
}  // namespace mmm_converter::lanes_test
