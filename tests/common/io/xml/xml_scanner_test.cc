// SPDX-License-Identifier: MIT
#include "common/io/xml/xml_scanner.h"

#include <gtest/gtest.h>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

XmlRange Ranges(std::string_view xml, int depth) {
  return FindXmlRanges(BytesOf(xml), "a.xml", depth);
}

TEST(XmlScanner, FindsElementsInTheText) {
  const std::string xml =
      "<?xml version='1.0'?><!-- <x> --><a b='>/'><c/><d ><e>1</e><!-- </d> --></d >"
      "<f><![CDATA[</f>]]><g><h/></g></f></a>\n";
  const XmlRange root = Ranges(xml, 2);
  EXPECT_EQ(root.name, "a");
  ASSERT_EQ(root.children.size(), 3u);
  const auto text = [&](const XmlRange& range) {
    return xml.substr(range.begin, range.end - range.begin);
  };
  EXPECT_EQ(text(root.children[0]), "<c/>");
  EXPECT_EQ(root.children[0].inner_begin, root.children[0].end);
  EXPECT_EQ(text(root.children[1]), "<d ><e>1</e><!-- </d> --></d >");
  EXPECT_EQ(text(root.children[1].children[0]), "<e>1</e>");
  EXPECT_EQ(root.children[1].children[0].inner_end - root.children[1].children[0].inner_begin, 1u);
  EXPECT_EQ(text(root.children[2]), "<f><![CDATA[</f>]]><g><h/></g></f>");
  EXPECT_TRUE(root.children[2].children[0].children.empty());  // deeper than asked for
  EXPECT_EQ(Ranges("<a><b/></a></a><c", 2).end, 11u);
  EXPECT_THROW(Ranges("<a><b></a>", 2), Error);
  EXPECT_THROW(Ranges("", 2), Error);
  EXPECT_THROW(Ranges("<a b='", 2), Error);
}

// Blocks end anywhere: in names, quotes, comments, the three bytes that end a section.
TEST(XmlScanner, FindsTheSameAcrossTheBlocksOfALargeFile) {
  const std::string part = "<p q=\"'>\">\n<!-- <p> -- --><![CDATA[ </p> ]] ]]>t</p><?i > ?>";
  std::string xml = "<a>";
  while (xml.size() < 5'000'000) {
    xml += part;
    xml.append(xml.size() % 7, ' ');
  }
  xml += "<z/></a>";
  const XmlRange root = Ranges(xml, 1);
  EXPECT_EQ(root.end, xml.size());
  EXPECT_EQ(root.children.back().name, "z");
  const std::string element = part.substr(0, part.find("<?"));
  for (std::size_t i = 0; i + 1 < root.children.size(); ++i) {
    const XmlRange& range = root.children[i];
    ASSERT_EQ(xml.compare(range.begin, range.end - range.begin, element), 0) << i;
  }
}

TEST(XmlScanner, CountsLines) {
  const std::string xml = "<a>\n\n<b\n c='\n'/>\n</a\n>\n<!-- ";
  const ByteSource content = BytesOf(xml);
  XmlScanner scanner(content);
  ASSERT_TRUE(scanner.Next());
  EXPECT_EQ(scanner.line(), 1);
  ASSERT_TRUE(scanner.Next());
  EXPECT_EQ(scanner.line(), 3);
  EXPECT_EQ(scanner.end_line(), 5);
  ASSERT_TRUE(scanner.Next());
  EXPECT_EQ(scanner.line(), 6);
  EXPECT_FALSE(scanner.Next());
  EXPECT_EQ(scanner.markup(), "\n<!-- ");
}

}  // namespace
}  // namespace mmm_converter
