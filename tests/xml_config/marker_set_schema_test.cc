// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/shared_data.h"
#include "tests/xml_config/xmllint.h"

namespace mmm_converter {
namespace {

constexpr const char* kSchema = "marker_set.xsd";

TEST(MarkerSetSchema, ShippedSetsAreValid) {
  int files = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(testing::SourcePath("xml_config/marker_sets"))) {
    if (entry.path().extension() != ".xml") continue;
    ++files;
    EXPECT_TRUE(testing::IsValidFile(kSchema, entry.path().string())) << entry.path();
  }
  EXPECT_GE(files, 2);
}

TEST(MarkerSetSchema, RefusesWhatTheReaderRefuses) {
  const auto is_valid = [](const std::string& mappings) {
    return testing::IsValidText(kSchema, "<MarkerSet name='a'>" + mappings + "</MarkerSet>");
  };
  EXPECT_TRUE(is_valid("<Mapping source='a' target='b' noiseScale='2' warning='w'/>"));
  EXPECT_TRUE(is_valid("<Marker name='a' segment='b' x_mm='0' y_mm='-1e3' z_mm='0.5'/>"));
  EXPECT_FALSE(is_valid("<Marker name='a' segment='b' x_mm='0' y_mm='0'/>"));
  EXPECT_FALSE(is_valid("<Marker name='a' segment='b' x_mm='0' y_mm='0' z_mm='x'/>"));
  EXPECT_FALSE(is_valid("<Marker name='a' segment='b' x_mm='0' y_mm='0' z_mm='20000'/>"));
  EXPECT_FALSE(is_valid(""));
  EXPECT_FALSE(is_valid("<Mapping source='a'/>"));
  EXPECT_FALSE(is_valid("<Mapping source='a' target=''/>"));
  EXPECT_FALSE(is_valid("<Mapping source='a' target='b' noiseScale='0'/>"));
  EXPECT_FALSE(is_valid("<Mapping source='a' target='b' weight='1'/>"));
  EXPECT_FALSE(testing::IsValidText(kSchema, "<MarkerSet/>"));
}

}  // namespace
}  // namespace mmm_converter
