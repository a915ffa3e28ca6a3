// SPDX-License-Identifier: MIT
#include "common/support/warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;

TEST(Warnings, KnowWhichFileAndMotionTheyAreAbout) {
  Warnings warnings;
  warnings.Add("first");
  {
    const WarningContext file(&warnings, "walk.xml");
    warnings.Add("second");
    {
      const WarningContext motion(&warnings, "walk.xml", "anna");
      warnings.Add("third");
    }
    warnings.Add("fourth");
  }
  warnings.Add("fifth");
  EXPECT_THAT(warnings.texts(), ElementsAre("first", "second", "third", "fourth", "fifth"));
  std::vector<std::string> about;
  for (const Warning& warning : warnings.all())
    about.push_back(warning.file + ":" + warning.motion);
  EXPECT_THAT(about, ElementsAre(":", "walk.xml:", "walk.xml:anna", "walk.xml:", ":"));
}

TEST(Warnings, AreAppendedWithWhatTheyAreAbout) {
  Warnings more;
  {
    const WarningContext file(&more, "a.c3d");
    more.Add("one");
    more.Add("two");
  }
  Warnings all;
  const WarningContext file(&all, "b.c3d");
  all.Add("two");
  all.AppendNew(more);
  EXPECT_THAT(all.texts(), ElementsAre("two", "one"));
  EXPECT_EQ(all.all()[1].file, "a.c3d");
  all.Append(more);
  EXPECT_THAT(all.texts(), ElementsAre("two", "one", "one", "two"));
}

TEST(Warnings, OfOneKindAreCountedAfterTheTenth) {
  Warnings warnings;
  const WarningContext file(&warnings, "a.c3d");
  for (int i = 0; i < 11; ++i) WarnOfKind(&warnings, "bad labels", "bad label");
  warnings.Add("other");
  for (int i = 0; i < 100000; ++i) WarnOfKind(&warnings, "bad labels", "bad label");
  const std::vector<std::string> texts = warnings.texts();
  ASSERT_EQ(texts.size(), 12U);
  EXPECT_EQ(texts[9], "bad label");
  EXPECT_EQ(texts[10], "100001 more bad labels");
  EXPECT_EQ(texts[11], "other");
  const WarningContext other(&warnings, "b.c3d");
  WarnOfKind(&warnings, "bad labels", "bad label");
  EXPECT_EQ(warnings.texts().back(), "bad label");
  WarnOfKind(nullptr, "bad labels", "bad label");
}

TEST(Warnings, NobodyNeedsToListen) {
  const WarningContext context(nullptr, "a.c3d");
  Warn(nullptr, "lost");
}

}  // namespace
}  // namespace mmm_converter
