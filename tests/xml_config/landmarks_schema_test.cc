// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "tests/support/shared_data.h"
#include "tests/xml_config/xmllint.h"

namespace mmm_converter {
namespace {

constexpr const char* kLandmarksSchema = "landmarks.xsd";

TEST(LandmarksSchema, TheShippedTableIsValid) {
  EXPECT_TRUE(
      testing::IsValidFile(kLandmarksSchema, testing::SourcePath("xml_config/landmarks.xml")));
}

TEST(LandmarksSchema, RefusesWhatTheReaderRefuses) {
  const auto is_valid = [](const std::string& attributes, const std::string& spellings) {
    return testing::IsValidText(kLandmarksSchema, "<Landmarks><Landmark " + attributes + ">" +
                                                      spellings + "</Landmark></Landmarks>");
  };
  const std::string place = "name='a' kind='skin' part='p' segment='s' x_mm='1' y_mm='0' z_mm='-2'";
  EXPECT_TRUE(is_valid(place + " deviation_mm='20' sided='true'", "heel 5mt knee{lat}"));
  EXPECT_TRUE(is_valid("name='a' kind='joint' part='p' marker='M' deviation_mm='1'", ""));
  EXPECT_FALSE(is_valid(place, "heel"));
  EXPECT_FALSE(is_valid(place + " deviation_mm='0'", "heel"));
  EXPECT_FALSE(is_valid(place + " deviation_mm='20'", "Heel"));
  EXPECT_FALSE(is_valid(place + " deviation_mm='20' sided='left'", "heel"));
  EXPECT_FALSE(is_valid("name='a' kind='bone' part='p' marker='M' deviation_mm='1'", "heel"));
  EXPECT_FALSE(testing::IsValidText(kLandmarksSchema, "<Landmarks><Heel/></Landmarks>"));
}

}  // namespace
}  // namespace mmm_converter
