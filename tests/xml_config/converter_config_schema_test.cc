// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "common/convert/converter_config.h"
#include "common/support/text.h"
#include "plugins/s2kf/s2kf_settings.h"
#include "tests/support/shared_data.h"
#include "tests/xml_config/xmllint.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAreArray;
using testing::SourcePath;

bool IsValidText(const std::string& xml) {
  return testing::IsValidText("converter_config.xsd", xml);
}

std::string Template() {
  s2kf::S2kfSettings defaults;
  return FormatConfigTemplate("S2KFConverter", s2kf::BindSettings(&defaults));
}

// The <xs:complexType> of an element's attributes.
const XmlElement* FindType(const XmlElement& schema, const std::string& name) {
  for (const XmlElement* type : schema.FindChildren("xs:complexType")) {
    if (*type->FindAttribute("name") == name) return type;
  }
  return nullptr;
}

const XmlElement* FindSchemaAttribute(const XmlElement& type, const std::string& name) {
  for (const XmlElement* attribute : type.FindChildren("xs:attribute")) {
    if (*attribute->FindAttribute("name") == name) return attribute;
  }
  return nullptr;
}

std::vector<std::string> FacetValues(const XmlElement& restriction, const std::string& facet) {
  std::vector<std::string> values;
  for (const XmlElement* element : restriction.FindChildren(facet)) {
    values.push_back(*element->FindAttribute("value"));
  }
  return values;
}

double Limit(const XmlElement& restriction, const std::string& facet, double otherwise) {
  const std::vector<std::string> values = FacetValues(restriction, facet);
  return values.empty() ? otherwise : ParseDouble(values.front()).value();
}

void ExpectSame(const Setting& setting, const XmlElement& attribute) {
  if (const std::string* type = attribute.FindAttribute("type")) {
    EXPECT_EQ(*type, "Boolean");
    EXPECT_THAT(setting.choices, ElementsAreArray({"true", "false"}));
    return;
  }
  const XmlElement* simple_type = attribute.FindChild("xs:simpleType");
  ASSERT_NE(simple_type, nullptr);
  const XmlElement* restriction = simple_type->FindChild("xs:restriction");
  ASSERT_NE(restriction, nullptr);
  EXPECT_EQ(*restriction->FindAttribute("base"), !setting.choices.empty() ? "xs:string"
                                                 : setting.is_integer     ? "xs:integer"
                                                                          : "xs:double");
  EXPECT_THAT(FacetValues(*restriction, "xs:enumeration"), ElementsAreArray(setting.choices));
  if (!setting.choices.empty()) return;
  EXPECT_EQ(Limit(*restriction, "xs:minInclusive", -INFINITY), setting.minimum);
  EXPECT_EQ(Limit(*restriction, "xs:maxInclusive", INFINITY), setting.maximum);
}

std::string Saying(std::string element, const std::string& attribute, const std::string& value) {
  return element.append(" ").append(attribute).append("=").append(value);
}

TEST(ConverterConfigSchema, HasTheSettingsOfTheConverterAndNoOthers) {
  s2kf::S2kfSettings defaults;
  const SettingTable table = s2kf::BindSettings(&defaults);
  const XmlElement schema = ReadXmlFile(SourcePath("xml_config/schema/converter_config.xsd"));
  for (const auto& [element, unused] : table.elements()) {
    SCOPED_TRACE(element);
    const XmlElement* type = FindType(schema, element);
    ASSERT_NE(type, nullptr);
    std::size_t attributes = 0;
    for (const Setting& setting : table.settings()) {
      if (setting.element != element) continue;
      SCOPED_TRACE(setting.attribute);
      ++attributes;
      const XmlElement* attribute = FindSchemaAttribute(*type, setting.attribute);
      ASSERT_NE(attribute, nullptr);
      ExpectSame(setting, *attribute);
    }
    EXPECT_EQ(type->FindChildren("xs:attribute").size(), attributes);
  }
  const auto& config = *schema.FindChild("xs:element")->FindChild("xs:complexType");
  EXPECT_EQ(config.FindChild("xs:all")->children.size(),
            table.elements().size() + 2);  // + Model, Output
}

TEST(ConverterConfigSchema, TemplateIsValidAndSaysTheDefaults) {
  const std::string xml = Template();
  EXPECT_TRUE(IsValidText(xml)) << xml;
  const ConverterConfig config = ParseConverterConfig(xml, "template");
  s2kf::S2kfSettings defaults;
  const SettingTable table = s2kf::BindSettings(&defaults);
  std::set<std::string> said;
  for (const XmlElement& element : config.plugin_elements) {
    for (const auto& [attribute, value] : element.attributes) {
      said.insert(Saying(element.name, attribute, value));
    }
  }
  for (const Setting& setting : table.settings()) {
    EXPECT_EQ(said.erase(Saying(setting.element, setting.attribute, setting.text())), 1u)
        << setting.element << " " << setting.attribute;
  }
  EXPECT_TRUE(said.empty());
}

TEST(ConverterConfigSchema, ShippedConfigurationsAreValidAndReadable) {
  int files = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(SourcePath("xml_config/converters"))) {
    if (entry.path().extension() != ".xml") continue;
    SCOPED_TRACE(entry.path());
    ++files;
    EXPECT_TRUE(testing::IsValidFile("converter_config.xsd", entry.path().string()));
    const ConverterConfig config = ReadConverterConfig(entry.path().string());
    s2kf::S2kfSettings settings;
    Diagnostics diagnostics(config.file);
    s2kf::BindSettings(&settings).Read(config.plugin_elements, &diagnostics);
    EXPECT_THAT(diagnostics.errors(), ::testing::IsEmpty());
    EXPECT_THAT(config.warnings, ::testing::IsEmpty());
  }
  EXPECT_GE(files, 2);
}

TEST(ConverterConfigSchema, ShippedDefaultSaysWhatTheProgramDoesWithoutIt) {
  const ConverterConfig shipped =
      ReadConverterConfig(SourcePath("xml_config/converters/s2kf_default.xml"));
  s2kf::S2kfSettings defaults;
  s2kf::S2kfSettings read;
  Diagnostics diagnostics(shipped.file);
  const SettingTable read_table = s2kf::BindSettings(&read);
  read_table.Read(shipped.plugin_elements, &diagnostics);
  const SettingTable default_table = s2kf::BindSettings(&defaults);
  for (std::size_t i = 0; i < default_table.settings().size(); ++i) {
    const Setting& setting = default_table.settings()[i];
    EXPECT_EQ(read_table.settings()[i].text(), setting.text())
        << setting.element << " " << setting.attribute;
  }
}

TEST(ConverterConfigSchema, TakesWhatTheReaderTakesAndRefusesWhatItRefuses) {
  const auto config = [](const std::string& inside) {
    return "<ConverterConfig type='S2KFConverter'>" + inside + "</ConverterConfig>";
  };
  EXPECT_TRUE(IsValidText(config("")));
  EXPECT_TRUE(
      IsValidText(config("<Model name='Winter'><MarkerMapping><Mapping source='C7' "
                         "target='MARKER_C7'/></MarkerMapping></Model>")));
  EXPECT_TRUE(IsValidText(config("<Filter samples='93'/><Model><Joints set='mmm40'/></Model>")));
  EXPECT_FALSE(IsValidText(config("<Filtre/>")));
  EXPECT_FALSE(IsValidText(config("<Filter samples='many'/>")));
  EXPECT_FALSE(IsValidText(config("<Filter sample='93'/>")));
  EXPECT_FALSE(IsValidText(config("<Filter/><Filter/>")));
  EXPECT_FALSE(
      IsValidText(config("<Model><MarkerMapping><Mapping source='C7' target='M' "
                         "noiseScale='0'/></MarkerMapping></Model>")));
  EXPECT_FALSE(IsValidText("<ConverterConfig/>"));
}

}  // namespace
}  // namespace mmm_converter
