// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/manifest_attributes.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <sstream>
#include <utility>

#include "common/io/robot/robot_exports.h"
#include "common/pipeline/conversion_options.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

constexpr Medium kMedium = Medium::kManifest;

std::string FileIn(const std::string& folder, const std::string& file) {
  return file.empty() ? "" : (fs::path(folder) / file).lexically_normal().string();
}

// A file beside the manifest, or the name of something shipped.
std::string FindShipped(const std::string& value, const std::string& folder) {
  return IsMissingName(value, folder) ? value : FileIn(folder, value);
}

bool IsOfPersons(const Option& option) {
  return (option.tasks & task::kCalibrate) != 0 && LongName(option) != "person";
}

bool SetExport(const std::string& format, const std::string& value, BatchEntry* entry) {
  value == "true" ? void(entry->exports.insert(format)) : void(entry->exports.erase(format));
  return value == "true" || value == "false";
}

const std::vector<Option>& DescribedAttributes() {
  static BatchEntry nobodys;
  static const std::vector<Option> attributes = AttributesOf(&nobodys);
  return attributes;
}

constexpr const char* kSchema = R"(<?xml version="1.0" encoding="UTF-8"?>
<!-- Manifests of batch: recordings to convert. An attribute of Batch or Group holds for every recording
     inside; of several, the innermost. An attribute's name ends with its unit. -->
<xs:schema xmlns:xs="http://www.w3.org/2001/XMLSchema">
  <xs:group name="Contents">
    <xs:choice>
      <xs:element name="Person" type="Person"/>
      <xs:element name="Group" type="Group"/>
      <xs:element name="Recording" type="Recording"/>
      <xs:element name="Metadata" type="Metadata"/>
    </xs:choice>
  </xs:group>
  <xs:complexType name="Group">
    <xs:group ref="Contents" minOccurs="0" maxOccurs="unbounded"/>
    <xs:attribute name="name" type="xs:string"/>
    <xs:attributeGroup ref="Settings"/>
  </xs:complexType>
  <xs:element name="Batch">
    <xs:complexType>
      <xs:complexContent><xs:extension base="Group">
        <xs:attribute name="folder" type="xs:string"/>
      </xs:extension></xs:complexContent>
    </xs:complexType>
  </xs:element>
  <xs:complexType name="Recording">
    <xs:sequence>
      <xs:element name="Metadata" type="Metadata" minOccurs="0" maxOccurs="unbounded"/>
    </xs:sequence>
    <xs:attribute name="file" type="Name" use="required"/>
    <xs:attribute name="id" type="Name"/>
    <xs:attributeGroup ref="Settings"/>
  </xs:complexType>
  <xs:complexType name="Person">
    <xs:attribute name="id" type="Name" use="required"/>
    <xs:attribute name="recordings" type="Name" use="required"/>
    <xs:attributeGroup ref="Calibration"/>
  </xs:complexType>
  <xs:complexType name="Metadata">
    <xs:attribute name="name" type="Name" use="required"/>
    <xs:attribute name="value" type="xs:string" use="required"/>
  </xs:complexType>
  <xs:simpleType name="Name">
    <xs:restriction base="xs:string"><xs:minLength value="1"/></xs:restriction>
  </xs:simpleType>
  <xs:attributeGroup name="Calibration">
{}  </xs:attributeGroup>
  <xs:attributeGroup name="Settings">
    <xs:attributeGroup ref="Calibration"/>
{}  </xs:attributeGroup>
</xs:schema>
)";

// The facets of a restriction; empty: any text.
std::string FacetsOf(const Option& option) {
  std::string facets;
  const auto add = [&facets](const char* name, const std::string& value) {
    facets += fmt::format("<xs:{} value=\"{}\"/>", name, value);
  };
  for (const std::string& choice : Choices(kMedium, option)) add("enumeration", choice);
  if (option.value.kind == OptionKind::kFrames) add("pattern", "[0-9]*:[0-9]*");
  if (option.value.kind == OptionKind::kAxis) add("pattern", "[+\\-]?[xyzXYZ]");
  const double unit = UnitOfAttribute(option);
  if (std::isfinite(option.value.least))
    add("minInclusive", fmt::format("{:.10g}", option.value.least / unit));
  if (std::isfinite(option.value.most))
    add("maxInclusive", fmt::format("{:.10g}", option.value.most / unit));
  return facets;
}

std::string SchemaOf(const Option& option) {
  const std::string facets = FacetsOf(option);
  const bool is_number = option.value.kind == OptionKind::kNumber;
  const char* const base = is_number ? "xs:double" : "xs:string";
  if (facets.empty()) {
    return fmt::format("    <xs:attribute name=\"{}\" type=\"{}\"/>\n", option.names.attribute,
                       base);
  }
  return fmt::format(
      "    <xs:attribute name=\"{}\">\n      <xs:simpleType><xs:restriction base=\"{}\">{}"
      "</xs:restriction></xs:simpleType>\n    </xs:attribute>\n",
      option.names.attribute, base, facets);
}

}  // namespace

std::vector<Option> AttributesOf(BatchEntry* entry) {
  std::vector<Option> attributes = Options(&entry->request);
  std::erase_if(attributes, [](const Option& option) { return *option.names.attribute == 0; });
  for (const Exporter& exporter : Exporters()) {
    const auto set = [entry, name = exporter.name](const std::string& value) {
      return SetExport(name, value, entry);
    };
    attributes.push_back(Row({"", exporter.name, ""}, {}, exporter.what, "", task::kConvert, set));
  }
  for (const RobotExporter& exporter : RobotExporters()) {
    const auto set = [entry, name = exporter.name](const std::string& value) {
      return SetExport(name, value, entry);
    };
    attributes.push_back(Row({"", exporter.name, ""}, {}, exporter.help, "", task::kRetarget, set));
  }
  return attributes;
}

std::vector<Option> PersonAttributesOf(BatchEntry* entry) {
  std::vector<Option> attributes = AttributesOf(entry);
  std::erase_if(attributes, [](const Option& option) { return !IsOfPersons(option); });
  return attributes;
}

BatchEntry ForCalibration(const BatchEntry& around) {
  BatchEntry entry;
  entry.request.input = around.request.input;
  entry.request.input.person.subject_file.clear();
  entry.request.converter = around.request.converter;
  for (const Option& option : AttributesOf(&entry)) {
    const auto setting = around.settings.find(option.names.attribute);
    const bool counts = (option.tasks & task::kCalibrate) != 0;
    if (counts && setting != around.settings.end()) entry.settings.insert(*setting);
  }
  return entry;
}

bool IsMissingName(const std::string& value, const std::string& folder) {
  const bool is_name = value.find('/') == std::string::npos && !value.ends_with(".xml");
  std::error_code failure;
  return is_name && !fs::exists(FileIn(folder, value), failure);
}

std::string ReadAttribute(const Option& option, const std::string& value,
                          const std::string& folder) {
  std::vector<std::string> values = {value};
  if (IsList(option)) {
    values.clear();
    std::istringstream parts(value);
    for (std::string part; std::getline(parts, part, ';');) {
      if (!Trim(part).empty()) values.emplace_back(Trim(part));
    }
  }
  const OptionKind kind = option.value.kind;
  for (std::string& one : values) {
    if (kind == OptionKind::kShipped) one = FindShipped(one, folder);
    if (kind == OptionKind::kFile || kind == OptionKind::kSubject) one = FileIn(folder, one);
  }
  return SetOption(option, values, UnitOfAttribute(option));
}

std::string DescribeAttributes() {
  std::string text;
  for (const Option& option : DescribedAttributes()) {
    text += fmt::format("       {:<16} {}\n", option.names.attribute,
                        HelpOf(kMedium, option, task::kConvert));
  }
  return text;
}

std::string WithManifestAdvice(const Error& error) {
  const std::string example = ExampleOf(kMedium, error.remedy());
  return error.what() + (example.empty() ? "" : " (in the manifest: " + example + ")");
}

std::string ManifestSchema() {
  std::string of_persons;
  std::string others;
  for (const Option& option : DescribedAttributes()) {
    (IsOfPersons(option) ? of_persons : others) += SchemaOf(option);
  }
  return fmt::format(kSchema, of_persons, others);
}

}  // namespace mmm_converter
