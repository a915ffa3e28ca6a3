// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "common/convert/converter_config.h"
#include "common/support/text.h"
#include "plugins/jacobian/jacobian_settings.h"
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

// The settings of one converter at their defaults, and the file that ships them.
struct Settings {
  explicit Settings(std::string converter)
      : type(std::move(converter)),
        table(type == "S2KFConverter" ? s2kf::BindSettings(&s2kf)
                                      : jacobian::BindSettings(&jacobian)),
        shipped(SourcePath(type == "S2KFConverter"
                               ? "xml_config/converters/s2kf_default.xml"
                               : "xml_config/converters/jacobian_least_squares.xml")) {}
  Settings(const Settings&) = delete;
  Settings& operator=(const Settings&) = delete;

  std::string type;
  s2kf::S2kfSettings s2kf;
  jacobian::JacobianSettings jacobian;
  SettingTable table;
  std::string shipped;
};

class ConverterSettings : public ::testing::TestWithParam<const char*> {
 protected:
  Settings defaults_{GetParam()};
};
INSTANTIATE_TEST_SUITE_P(Converters, ConverterSettings,
                         ::testing::Values("S2KFConverter", "JacobianConverter"));

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

TEST_P(ConverterSettings, AreInTheSchema) {
  const SettingTable& table = defaults_.table;
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
}

TEST(ConverterConfigSchema, HasNoOtherElements) {
  const XmlElement schema = ReadXmlFile(SourcePath("xml_config/schema/converter_config.xsd"));
  const auto& config = *schema.FindChild("xs:element")->FindChild("xs:complexType");
  EXPECT_EQ(config.FindChild("xs:all")->children.size(),
            Settings("S2KFConverter").table.elements().size() +
                Settings("JacobianConverter").table.elements().size() + 2);  // + Model, Output
}

TEST_P(ConverterSettings, TemplateIsValidAndSaysTheDefaults) {
  const SettingTable& table = defaults_.table;
  const std::string xml = FormatConfigTemplate(defaults_.type, table);
  EXPECT_TRUE(IsValidText(xml)) << xml;
  const ConverterConfig config = ParseConverterConfig(xml, "template");
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
    Warnings warnings;
    const ConverterConfig config = ReadConverterConfig(entry.path().string(), &warnings);
    const Settings settings(config.type);
    Diagnostics diagnostics(config.file);
    settings.table.Read(config.plugin_elements, &diagnostics);
    EXPECT_THAT(diagnostics.errors(), ::testing::IsEmpty());
    EXPECT_THAT(warnings.texts(), ::testing::IsEmpty());
  }
  EXPECT_GE(files, 7);
}

TEST_P(ConverterSettings, ShippedDefaultSaysWhatTheProgramDoesWithoutIt) {
  const ConverterConfig shipped = ReadConverterConfig(defaults_.shipped);
  const Settings read(defaults_.type);
  Diagnostics diagnostics(shipped.file);
  read.table.Read(shipped.plugin_elements, &diagnostics);
  for (std::size_t i = 0; i < defaults_.table.settings().size(); ++i) {
    const Setting& setting = defaults_.table.settings()[i];
    EXPECT_EQ(read.table.settings()[i].text(), setting.text())
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
  EXPECT_TRUE(IsValidText(config("<Model><Subject file='1723.xml'/></Model>")));
  EXPECT_FALSE(IsValidText(config("<Model><Subject/></Model>")));
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
