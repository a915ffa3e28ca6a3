// SPDX-License-Identifier: MIT
#include "common/convert/marker_set_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/test_folder.h"

namespace mmm_converter::testing {
namespace {

using ::testing::HasSubstr;

TEST(MarkerSetTextTest, IsReadBack) {
  MarkerSet set;
  set.name = "ours & theirs";
  set.description = "two <markers>";
  set.places = {{"L.Knee \"a\"", "LKsegment_joint", {0.0123, -0.00001, 0.5}, 0},
                {"m2", "root_joint", {0, 0.02, -0.03}, 0}};
  set.pairs = {{"m2", "m2"}, {"other", "MARKER_C7", 2, "somewhere"}};
  const std::string text = FormatMarkerSet(set, "a head -- with dashes", {"sure"}, {"m3: unsure"});
  EXPECT_THAT(text, HasSubstr("m3: unsure"));
  const std::string file = TestFolder() + "/set.xml";
  std::ofstream(file) << text;
  const MarkerSet read = ReadMarkerSet(file);
  EXPECT_EQ(read.name, set.name);
  EXPECT_EQ(read.description, set.description);
  ASSERT_EQ(read.places.size(), 2);
  EXPECT_EQ(read.places[0].marker, set.places[0].marker);
  EXPECT_EQ(read.places[0].segment, "LKsegment_joint");
  // Places have one decimal of a millimetre.
  EXPECT_LT((read.places[0].p_SM - set.places[0].p_SM).norm(), 1e-4);
  EXPECT_LT((read.places[1].p_SM - set.places[1].p_SM).norm(), 1e-12);
  ASSERT_EQ(read.pairs.size(), 3);  // the mapping, and each place under its own name
  EXPECT_EQ(read.pairs[0].target, "MARKER_C7");
  EXPECT_EQ(read.pairs[0].noise_scale, 2);
}

}  // namespace
}  // namespace mmm_converter::testing
