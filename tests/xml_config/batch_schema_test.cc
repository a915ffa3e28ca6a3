// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "MMMConverterS2KF/batch/manifest.h"
#include "MMMConverterS2KF/batch/manifest_attributes.h"
#include "common/support/error.h"
#include "tests/support/test_folder.h"
#include "tests/xml_config/xmllint.h"

namespace mmm_converter {
namespace {

bool IsValid(const std::string& xml) {
  const std::string schema = testing::TestFolder() + "/batch.xsd";
  std::ofstream(schema) << ManifestSchema();
  return testing::IsValidText(schema, xml);
}

bool IsReadable(const std::string& xml) {
  try {
    ParseManifest(xml, "manifest.xml");
    return true;
  } catch (const Error&) {
    return false;
  }
}

TEST(BatchSchema, TakesTheTemplate) { EXPECT_TRUE(IsValid(ManifestTemplate())); }

TEST(BatchSchema, AgreesWithTheReader) {
  const auto recording = [](const std::string& attributes) {
    return "<Batch><Group><Recording file='a.c3d' " + attributes + "/></Group></Batch>";
  };
  for (const std::string& xml :
       {recording("height_m='0.5' mass_kg='400' handLength_mm='50' csv='true' unit='in'"),
        recording("up='-X' frames=':' format='1.0' rate_hz='1' ignoreResiduals='false'"),
        std::string("<Batch><Person id='a' recordings='b' height_m='1.8'/><Recording file='a' "
                    "person='a'/></Batch>"),
        std::string("<Batch><Metadata name='a' value=''/><Recording file='a'><Metadata name='a' "
                    "value='b'/></Recording></Batch>")}) {
    EXPECT_TRUE(IsValid(xml)) << xml;
    EXPECT_TRUE(IsReadable(xml)) << xml;
  }
  for (const std::string& xml :
       {recording("height_m='0.4'"), recording("mass_kg='x'"), recording("handLength_mm='0.18'"),
        recording("csv='yes'"), recording("unit='ft'"), recording("up='w'"),
        recording("frames='5'"), recording("format='3'"), recording("rate_hz='0.5'"),
        recording("selfCalibrate='1'"), recording("ignoreResiduals=''"), recording("what='1'"),
        recording("label='1'"), recording("id=''"),
        std::string("<Batch><Person id='a'/><Recording file='a'/></Batch>"),
        std::string(
            "<Batch><Person id='a' recordings='b' csv='true'/><Recording file='a'/></Batch>"),
        std::string("<Batch><Group file='a.c3d'/></Batch>"),
        std::string("<Batch><Recording/></Batch>"),
        std::string("<Batch><Metadata value='1'/><Recording file='a'/></Batch>")}) {
    EXPECT_FALSE(IsValid(xml)) << xml;
    EXPECT_FALSE(IsReadable(xml)) << xml;
  }
}

TEST(BatchSchema, HasEveryAttribute) {
  BatchEntry entry;
  for (const Option& attribute : AttributesOf(&entry)) {
    std::string xml;
    for (const char* value :
         {"1", "true", "mm", "x", ":", "2.0", "100", "x.xml", "isaac", "file"}) {
      xml = fmt::format(
          "<Batch {}='{}'><Recording file='a.c3d' robot='g.xml' "
          "robotOrder='isaac'/></Batch>",
          attribute.names.attribute, value);
      if (IsReadable(xml)) break;
    }
    EXPECT_TRUE(IsReadable(xml)) << xml;
    EXPECT_TRUE(IsValid(xml)) << xml;
  }
}

}  // namespace
}  // namespace mmm_converter
