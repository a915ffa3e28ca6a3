// SPDX-License-Identifier: MIT
#include "common/io/xml/long_xml.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// name, line, text without blanks and so on of an element and all below it.
std::string Outline(const XmlElement& element) {
  std::string text = fmt::format("{}@{}[", element.name, element.line);
  for (const auto& [name, value] : element.attributes) text += fmt::format("{}={};", name, value);
  std::string words = element.text;  // the stand-ins leave new lines behind
  std::erase_if(words, [](char c) { return c == ' ' || c == '\n'; });
  text += words + "]";
  for (const XmlElement& child : element.children) text += Outline(child);
  return text + "/";
}

/// The tree with the elements that were left out put back.
XmlElement Whole(LongXml* xml, const XmlElement& element) {
  XmlElement whole = element;
  whole.children.clear();
  for (const XmlElement& child : element.children) {
    if (!child.Is("m")) {
      whole.children.push_back(Whole(xml, child));
      continue;
    }
    XmlElement only = element;
    only.children = {child};
    xml->ForEachChild(only, "m", [&](const XmlElement& many) { whole.children.push_back(many); });
  }
  return whole;
}

std::string OutlineOrError(const std::string& text) {
  try {
    LongXml xml(BytesOf(text), "walk.xml", {"M"}, 3);
    std::string outline = Outline(Whole(&xml, xml.root()));
    xml.CheckTheRest();
    return outline;
  } catch (const Error& error) {
    return error.what();
  }
}

std::string Reference(const std::string& text) {
  try {
    return Outline(ParseXml(text, "walk.xml"));
  } catch (const Error& error) {
    return error.what();
  }
}

const char* const kText =
    "<?xml version='1.0'?>\n<a><b>\n<c d='1'>\n <m t='&lt;'>1\n<n/></m>\n<M/><m>2<!-- </m> --></m>"
    "x<m\n>3</m><!-- <m> --><m><m>4</m></m>\n</c></b>\n<e>6</e></a>\n";

TEST(LongXml, HasWhatTheWholeTreeHas) {
  EXPECT_EQ(OutlineOrError(kText), Reference(kText));
  LongXml xml(BytesOf(kText), "walk.xml", {"m"}, 3);
  EXPECT_EQ(Outline(*xml.root().FindChild("e")), "e@9[6]/");
  std::vector<int> lines;
  const XmlElement& c = *xml.root().FindChild("b")->FindChild("c");
  xml.ForEachChild(c, "m", [&](const XmlElement& m) { lines.push_back(m.line); });
  EXPECT_THAT(lines, ElementsAre(4, 6, 6, 6, 7));
}

TEST(LongXml, LeavesOutMillions) {
  std::string text = "<a><b><c>";
  for (int i = 0; i < 100000; ++i) text += fmt::format("\n<m t=\"{}\"><n>{}</n></m>", i, i);
  text += "</c></b></a>";
  LongXml xml(BytesOf(text), "walk.xml", {"m"}, 3);
  const XmlElement& c = xml.root().children[0].children[0];
  EXPECT_LT(c.children.size(), 20u);
  int next = 0;
  xml.ForEachChild(c, "m", [&](const XmlElement& m) {
    ASSERT_EQ(m.children.at(0).text, std::to_string(next));
    ASSERT_EQ(m.line, 2 + next);
    ++next;
  });
  EXPECT_EQ(next, 100000);
}

TEST(LongXml, SaysWhereItIsNotWellFormed) {
  const auto message = [](const std::string& many) {
    return OutlineOrError("<a>\n<b><c>\n<m/>\n" + many + "</c></b></a>");
  };
  EXPECT_THAT(message("<m>\n<n>\n</m>"), HasSubstr("not well-formed XML: an el"));
  EXPECT_THAT(message("<m>\n<n></o>\n</m>"), HasSubstr("walk.xml:5: not well-formed XML: an el"));
  EXPECT_THAT(message("<m>\n<n a=1/></m>"), HasSubstr("walk.xml:5: not well-formed XML: an att"));
  EXPECT_THAT(OutlineOrError("<a><b><c>\n<m>"), HasSubstr("walk.xml:2: not well-formed XML: <m>"));
  EXPECT_THAT(message("<m"), HasSubstr("walk.xml:4: not well-formed XML"));
  LongXml unvisited(BytesOf("<a><b><c><m>\n<n></o></m></c></b></a>"), "walk.xml", {"m"}, 3);
  EXPECT_THROW(unvisited.CheckTheRest(), Error);
}

// A damaged text is the same tree as for the parser, or refused.
TEST(LongXml, DamagedTextsAreReadAsByTheParserOrRefused) {
  std::mt19937_64 random(4);
  constexpr std::string_view kBytes("<>/='\"!-?[]& am\0\n", 17);
  int read = 0;
  for (int i = 0; i < 30000; ++i) {
    std::string text = kText;
    for (int n = 0; n < 1 + i % 3; ++n) {
      text[random() % text.size()] = kBytes[random() % kBytes.size()];
    }
    const std::string outline = OutlineOrError(text);
    if (outline.find("not well-formed") != std::string::npos) continue;
    ASSERT_EQ(outline, Reference(text)) << text;
    ++read;
  }
  EXPECT_GT(read, 1000);
}

}  // namespace
}  // namespace mmm_converter
