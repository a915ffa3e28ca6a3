// SPDX-License-Identifier: MIT
#include "common/io/mmm/processor_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(ProcessorConfig, ReadsMetresKilogramsAndCentimetres) {
  const BodySize config = ParseProcessorConfig(
      "<?xml version='1.0'?><ModelProcessorConfig type='Winter'><Height>1.79</Height>"
      "<Mass> 78 </Mass><HandLength>18.9</HandLength></ModelProcessorConfig>",
      "1723.xml");
  EXPECT_EQ(config.height, 1.79);
  EXPECT_EQ(config.mass, 78);
  EXPECT_DOUBLE_EQ(config.hand_length.value(), 0.189);
}

TEST(ProcessorConfig, MayLeaveOutEverything) {
  const BodySize config = ParseProcessorConfig("<ModelProcessorConfig type='Winter'/>", "p.xml");
  EXPECT_TRUE(config.empty());
}

TEST(ProcessorConfig, RefusesOtherFilesAndWords) {
  EXPECT_THAT([] { ParseProcessorConfig("<MMM/>", "p.xml"); },
              ThrowsMessage<Error>(HasSubstr("p.xml:1: this is a <MMM> file")));
  EXPECT_THAT([] { ParseProcessorConfig("<ModelProcessorConfig type='X'/>", "p.xml"); },
              ThrowsMessage<Error>(HasSubstr("needs type=\"Winter\"")));
  EXPECT_THAT(
      [] {
        ParseProcessorConfig(
            "<ModelProcessorConfig type='Winter'>\n<Height>1,79</Height>\n<Mass>nan</Mass>"
            "</ModelProcessorConfig>",
            "p.xml");
      },
      ThrowsMessage<Error>("p.xml:2: <Height>: \"1,79\" is not a number; give metres\n"
                           "p.xml:3: <Mass>: \"nan\" is not a number; give kilograms"));
}

}  // namespace
}  // namespace mmm_converter
