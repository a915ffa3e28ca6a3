// SPDX-License-Identifier: MIT
#include "common/io/mmm/processor_config.h"

#include <fmt/core.h>

#include <cmath>

#include "common/io/bytes/file_content.h"
#include "common/io/xml/xml_document.h"
#include "common/support/diagnostics.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 20;
constexpr double kCentimetre = 0.01;

std::optional<double> ReadNumber(const XmlElement& config, const char* name, const char* unit,
                                 double si_factor, Diagnostics* diagnostics) {
  const XmlElement* element = config.FindChild(name);
  if (element == nullptr) return std::nullopt;
  const auto number = ParseDouble(element->text);
  if (!number || !std::isfinite(*number)) {
    diagnostics->AddError(element->line, fmt::format("<{}>: \"{}\" is not a number; give {}", name,
                                                     element->text, unit));
    return std::nullopt;
  }
  return *number * si_factor;
}

}  // namespace

BodySize ParseProcessorConfig(const std::string& xml, const std::string& file) {
  const XmlElement root = ParseXml(xml, file);
  if (!root.Is("ModelProcessorConfig")) {
    throw Error(
        fmt::format("{}:{}: this is a <{}> file; a person's file starts with "
                    "<ModelProcessorConfig type=\"Winter\">",
                    file, root.line, root.name));
  }
  const std::string* type = root.FindAttribute("type");
  if (type == nullptr || *type != "Winter") {
    throw Error(
        fmt::format("{}:{}: <ModelProcessorConfig> needs type=\"Winter\"", file, root.line));
  }
  Diagnostics diagnostics(file);
  BodySize config;
  config.height = ReadNumber(root, "Height", "metres", 1, &diagnostics);
  config.mass = ReadNumber(root, "Mass", "kilograms", 1, &diagnostics);
  config.hand_length = ReadNumber(root, "HandLength", "centimetres", kCentimetre, &diagnostics);
  diagnostics.ThrowIfErrors();
  return config;
}

BodySize ReadProcessorConfig(const std::string& path) {
  return ParseProcessorConfig(ReadFileContent(path, kMaxBytes), path);
}

}  // namespace mmm_converter
