// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "tests/support/shared_data.h"
#include "tests/xml_config/xmllint.h"

namespace mmm_converter {
namespace {

constexpr const char* kBonesSchema = "bones.xsd";

TEST(BonesSchema, TheShippedTableIsValid) {
  EXPECT_TRUE(testing::IsValidFile(kBonesSchema, testing::SourcePath("xml_config/bones.xml")));
}

TEST(BonesSchema, RefusesWhatTheReaderRefuses) {
  EXPECT_TRUE(testing::IsValidText(
      kBonesSchema, "<Bones><Side left='l' right='r'/><Bone kind='hip'>thigh</Bone></Bones>"));
  EXPECT_FALSE(testing::IsValidText(kBonesSchema, "<Bones><Bone kind='tail'>a</Bone></Bones>"));
  EXPECT_FALSE(testing::IsValidText(kBonesSchema, "<Bones><Bone>thigh</Bone></Bones>"));
  EXPECT_FALSE(testing::IsValidText(kBonesSchema, "<Bones><Side left='l'/></Bones>"));
}

}  // namespace
}  // namespace mmm_converter
