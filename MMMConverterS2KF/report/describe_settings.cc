// SPDX-License-Identifier: MIT
// What is in files that a user writes or takes: plugins, configurations, marker sets, persons.

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/report/describe.h"
#include "common/convert/converter_config.h"
#include "common/convert/marker_set.h"
#include "common/convert/plugin_loader.h"
#include "common/io/mmm/processor_config.h"
#include "common/io/xml/xml_document.h"
#include "common/support/diagnostics.h"
#include "common/support/error.h"
#include "common/support/suggestion.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kMostSubjectBytes = std::size_t{8} << 20;

std::string Attribute(const XmlElement& element, const char* name) {
  const std::string* value = element.FindAttribute(name);
  return value == nullptr ? "" : *value;
}

Json NamesOf(const XmlElement& root, const char* list, const char* member) {
  Json names = Json::array();
  if (const XmlElement* const parent = root.FindChild(list)) {
    for (const XmlElement* const one : parent->FindChildren(member)) {
      names.push_back(Attribute(*one, "name"));
    }
  }
  return names;
}

std::string Shown(const std::optional<double>& value, const char* unit) {
  return value ? fmt::format("{:.6g} {}", *value, unit) : "not stated";
}

Json OrNull(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

// As its converter complains of elements, where that is here.
void CheckElements(const ConverterConfig& config, Warnings* warnings) {
  if (config.type.empty()) return;
  std::string known_by;
  try {
    known_by = LoadPluginByName(config.type, warnings).factory().config_template();
  } catch (const Error& error) {
    warnings->Add(fmt::format("{}: its elements are not checked: {}", config.file, error.what()));
    return;
  }
  std::vector<std::string> known;
  for (const XmlElement& one : ParseConverterConfig(known_by, config.type).plugin_elements) {
    known.push_back(one.name);
  }
  Diagnostics diagnostics(config.file);
  for (const XmlElement& one : config.plugin_elements) {
    if (std::count(known.begin(), known.end(), one.name) > 0) continue;
    const std::string closest = ClosestName(one.name, known);
    diagnostics.AddError(
        one.line,
        fmt::format("unknown element <{}>{}; use {}", one.name,
                    closest.empty() ? "" : " (did you mean " + closest + "?)", JoinNames(known)));
  }
  diagnostics.ThrowIfErrors();
}

}  // namespace

Description DescribePlugin(const FileStart& file, const ReadRecordingOptions&) {
  const LoadedPlugin plugin(file.path);
  const MotionConverterFactory& factory = plugin.factory();
  return {fmt::format("{}: converter plugin\nname       {}\nversion    {}\nwhat       {}\n",
                      file.path, factory.name(), plugin.version(), factory.description()),
          FormatJson({{"kind", "plugin"},
                      {"file", file.path},
                      {"name", factory.name()},
                      {"version", plugin.version()},
                      {"description", factory.description()}}),
          {}};
}

Description DescribeConfiguration(const FileStart& file, const ReadRecordingOptions&) {
  Warnings warnings;
  const ConverterConfig config = ReadConverterConfig(file.path, &warnings);
  CheckElements(config, &warnings);
  std::vector<std::string> elements;
  for (const XmlElement& element : config.plugin_elements) elements.push_back(element.name);
  const std::string mapping = config.marker_pairs.empty()
                                  ? "set " + config.marker_set
                                  : fmt::format("{} pairs", config.marker_pairs.size());
  const std::string joints =
      config.joints.empty() ? "set " + config.joint_set : std::to_string(config.joints.size());
  return {fmt::format("{}: configuration for {}\nmapping    {}\njoints     {}\nsettings   {}\n",
                      file.path, config.type.empty() ? "another converter" : config.type, mapping,
                      joints, JoinNames(elements, ", ")),
          FormatJson({{"kind", "configuration"},
                      {"file", file.path},
                      {"converter", config.type},
                      {"marker_mapping", mapping},
                      {"joints", joints},
                      {"elements", elements},
                      {"warnings", warnings.texts()}}),
          warnings};
}

Description DescribeMarkerSet(const FileStart& file, const ReadRecordingOptions&) {
  const MarkerSet set = ReadMarkerSet(file.path);
  Json pairs = Json::array();
  std::string text =
      fmt::format("{}: marker set {}\nwhat       {}\nmappings   {}\n", file.path, set.name,
                  set.description.empty() ? "not described" : set.description, set.pairs.size());
  for (const MarkerPair& pair : set.pairs) {
    pairs.push_back({{"label", pair.source}, {"marker", pair.target}});
    text += fmt::format("  {:<14} is {}\n", pair.source, pair.target);
  }
  Json places = Json::array();
  text += fmt::format("places     {}\n", set.places.size());
  for (const MarkerPlace& place : set.places) {
    const Eigen::Vector3d& p = place.p_SM;
    places.push_back({{"marker", place.marker},
                      {"segment", place.segment},
                      {"offset_m", {p.x(), p.y(), p.z()}}});
    text += fmt::format("  {:<14} on {:<24} at {:7.4f} {:7.4f} {:7.4f} m\n", place.marker,
                        place.segment, p.x(), p.y(), p.z());
  }
  return {text,
          FormatJson({{"kind", "marker set"},
                      {"file", file.path},
                      {"name", set.name},
                      {"description", set.description},
                      {"mappings", pairs},
                      {"places", places}}),
          {}};
}

// Without the model of which the subject is, which alone can say whether its names are right.
Description DescribeSubjectFile(const FileStart& file, const ReadRecordingOptions&) {
  const XmlElement root = ReadXmlFile(file.path, kMostSubjectBytes);
  const Json segments = NamesOf(root, "Segments", "Segment");
  const Json markers = NamesOf(root, "Markers", "Marker");
  const Json sources = NamesOf(root, "Provenance", "Recording");
  const auto number = [&](const char* name) -> Json {
    const auto value = ParseDouble(Attribute(root, name));
    return value ? Number(*value, 6) : Json(nullptr);
  };
  const Json height = number("height_m");
  const Json mass = number("mass_kg");
  if (height.is_null() || mass.is_null()) {
    throw Error(fmt::format("{}:{}: <Subject> needs height_m and mass_kg, each a number", file.path,
                            root.line));
  }
  std::string recordings;
  for (const Json& source : sources) recordings += "  " + source.get<std::string>() + "\n";
  return {fmt::format("{}: subject {}\nmodel      {}\nperson     height {:.6g} m, mass {:.6g} kg\n"
                      "segments   {}\nmarkers    {}\nrecordings {}\n{}",
                      file.path, Attribute(root, "name"), Attribute(root, "model"),
                      height.get<double>(), mass.get<double>(), segments.size(), markers.size(),
                      sources.size(), recordings),
          FormatJson({{"kind", "subject"},
                      {"file", file.path},
                      {"name", Attribute(root, "name")},
                      {"model", Attribute(root, "model")},
                      {"height_m", height},
                      {"mass_kg", mass},
                      {"hand_length_mm", number("hand_length_mm")},
                      {"segments", segments},
                      {"markers", markers},
                      {"recordings", sources}}),
          {}};
}

Description DescribePerson(const FileStart& file, const ReadRecordingOptions&) {
  const BodySize person = ReadProcessorConfig(file.path);
  return {fmt::format("{}: person (ModelProcessorConfig)\nheight     {}\nmass       {}\n"
                      "hand       {}\n",
                      file.path, Shown(person.height, "m"), Shown(person.mass, "kg"),
                      Shown(person.hand_length, "m")),
          FormatJson({{"kind", "person"},
                      {"file", file.path},
                      {"height_m", OrNull(person.height)},
                      {"mass_kg", OrNull(person.mass)},
                      {"hand_length_m", OrNull(person.hand_length)}}),
          {}};
}

}  // namespace mmm_converter
