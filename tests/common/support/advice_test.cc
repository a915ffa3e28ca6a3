// SPDX-License-Identifier: MIT
#include "common/support/advice.h"

#include <gtest/gtest.h>

namespace mmm_converter {
namespace {

const Wording kPlain = {[](const std::string& name) { return name; },
                        [](Remedy /*remedy*/) { return ""; }};

TEST(Advice, IsPlainUntilAProgramSaysMore) {
  EXPECT_EQ(OptionText("subject-file"), "subject-file");
  EXPECT_EQ(WithAdvice(Error("no height", Remedy::kHeight)), "no height");
}

TEST(Advice, IsWordedByTheProgram) {
  SetWording({[](const std::string& name) { return "/" + name; },
              [](Remedy remedy) { return remedy == Remedy::kHeight ? "; give /height" : ""; }});
  EXPECT_EQ(OptionText("subject-file"), "/subject-file");
  EXPECT_EQ(WithAdvice(Error("no height", Remedy::kHeight)), "no height; give /height");
  EXPECT_EQ(WithAdvice("no mass", Remedy::kMass), "no mass");
  SetWording(kPlain);
}

}  // namespace
}  // namespace mmm_converter
