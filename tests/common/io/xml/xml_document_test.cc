// SPDX-License-Identifier: MIT
#include "common/io/xml/xml_document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/support/error.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using ::testing::HasSubstr;

std::string XmlMessageOf(const std::string& xml) {
  try {
    ParseXml(xml, "walk.xml");
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(XmlDocument, KeepsNamesAttributesTextChildrenAndLines) {
  const XmlElement root = ParseXml(
      "\xEF\xBB\xBF<?xml version='1.0'?>\n<!-- a comment -->\n<MMM version=\"2.0\">\n"
      "  <Motion Name='a &amp; b'>  1 2 <!-- c --> 3\n</Motion>\n  <motion/>\n</MMM>\n",
      "walk.xml");
  EXPECT_EQ(root.name, "MMM");
  EXPECT_EQ(root.line, 3);
  ASSERT_EQ(root.children.size(), 2u);
  EXPECT_EQ(root.FindChildren("MOTION").size(), 2u);
  const XmlElement& motion = *root.FindChild("motion");
  EXPECT_EQ(motion.line, 4);
  ASSERT_NE(motion.FindAttribute("name"), nullptr);
  EXPECT_EQ(*motion.FindAttribute("name"), "a & b");
  EXPECT_EQ(motion.text, "1 2  3");
  EXPECT_EQ(motion.FindAttribute("other"), nullptr);
  EXPECT_EQ(root.FindChild("Sensors"), nullptr);
}

TEST(XmlDocument, SaysFileAndLineOfWhatIsWrong) {
  EXPECT_THAT(XmlMessageOf("<a>\n<b>\n</a>"),
              HasSubstr("walk.xml:2: not well-formed XML: an element"));
  EXPECT_THAT(XmlMessageOf("<a>\n<b c=1/>\n</a>"), HasSubstr("walk.xml:2: not well-formed XML"));
  for (const char* text : {"<a>\n<b></b>", "<a>\n<b/>", "<a>", "<a>text"}) {
    EXPECT_THAT(XmlMessageOf(text), HasSubstr("end tag")) << text;
  }
  for (const char* text :
       {"<a></a", "<a><b", "<a><!-- b", "<a b='1", "<a>b", "text", "</a>", "<1/>"}) {
    EXPECT_THAT(XmlMessageOf(text), ::testing::Not(HasSubstr("XML_"))) << text;
  }
  EXPECT_THAT(XmlMessageOf("<a/>\n<b/>"),
              HasSubstr("walk.xml:2: not well-formed XML: <b> is a second"));
  EXPECT_THAT(XmlMessageOf("   "), HasSubstr("there is no element"));
  EXPECT_THAT(XmlMessageOf("just text"), HasSubstr("walk.xml:"));
  EXPECT_THAT(XmlMessageOf("<!-- nothing -->"), HasSubstr("there is no element"));
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  EXPECT_THAT(XmlMessageOf(deep), HasSubstr("nested too deeply"));
}

TEST(XmlDocument, SaysWhatIsWrongWithAFile) {
  const std::string& folder = testing::TestFolder();
  EXPECT_THROW(ReadXmlFile(folder), Error);
  EXPECT_THROW(ReadXmlFile(folder + "/no_such_file.xml"), Error);
}

// The parser's time is quadratic in the attributes of an element.
TEST(XmlDocument, RefusesAnElementOfManyAttributesBeforeItIsParsed) {
  const auto element = [](int count) {
    std::string text = "<!-- it's -->\n<a";
    for (int i = 0; i < count; ++i) text += " n" + std::to_string(i) + "='='";
    return text + "/>";
  };
  EXPECT_EQ(ParseXml(element(256), "a.xml").attributes.size(), 256U);
  try {
    ParseXml(element(200000), "a.xml");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "a.xml:2: <a> has 200000 attributes, more than the 256 that are read");
  }
}

TEST(XmlDocument, ReadsNoOtherFileAndExpandsNothing) {
  const XmlElement root =
      ParseXml("<!DOCTYPE a SYSTEM \"file:///etc/passwd\"><a b='&x;'>&x;</a>", "a.xml");
  EXPECT_EQ(*root.FindAttribute("b"), "&x;");
  EXPECT_EQ(root.text, "&x;");
  for (const char* const declaration :
       {"[<!ENTITY y SYSTEM 'file:///etc/passwd'>]>", "[<!ENTITY x 'ha'><!ENTITY y '&x;&x;'>]>",
        "[<!ENTITY y '&y;'>"}) {
    try {
      const std::string xml = std::string("<!DOCTYPE a ") + declaration + "<a>&y;</a>";
      EXPECT_EQ(ParseXml(xml, "a.xml").text, "&y;");
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("not well-formed XML"));
    }
  }
}

// A tree takes as much for a short element as for a long one.
TEST(XmlDocument, RefusesMillionsOfShortElementsBeforeTheyAreParsed) {
  const auto many = [](const std::string& text) {
    std::string xml = "<a>";
    for (int i = 0; i < 500000; ++i) xml += text;
    return XmlMessageOf(xml + "</a>");
  };
  const char* const kTooShort = "so short that they would take";
  EXPECT_THAT(many("<b/>"), HasSubstr("500001 elements, 0 attributes and 0 texts"));
  EXPECT_THAT(many("<b c=''/>"), HasSubstr(kTooShort));
  EXPECT_THAT(many("<!---->t"), HasSubstr(kTooShort));
  EXPECT_EQ(many("<element_abcde/>"), "no error");
}

}  // namespace
}  // namespace mmm_converter
