// SPDX-License-Identifier: MIT
#include "common/io/osim/tool_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "common/io/osim/osim_values.h"
#include "common/io/osim/osim_xml.h"
#include "common/io/xml/xml_document.h"
#include "common/io/xml/xml_text.h"
#include "common/support/error.h"
#include "common/support/folder.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTools[] = {"InverseKinematicsTool", "ScaleTool", "InverseDynamicsTool"};

/// The text of a property that names a file; empty: none.
std::string FileOf(const XmlElement& object, std::string_view name) {
  const std::string_view text = Trim(OsimText(object, name));
  return EqualIgnoringCase(text, "Unassigned") ? "" : std::string(text);
}

/// The tool's element; null: there is none.
const XmlElement* FindTool(const XmlElement& root) {
  const bool is_document = root.Is("OpenSimDocument");
  for (const char* name : kTools) {
    if (root.Is(name)) return &root;
    const XmlElement* tool = is_document ? root.FindChild(name) : nullptr;
    if (tool != nullptr) return tool;
  }
  return nullptr;
}

/// "-1 -1" and the like are everything, as are infinite times.
std::optional<std::array<double, 2>> TimesOf(const XmlElement& object, const std::string& file) {
  const XmlElement* element = object.FindChild("time_range");
  if (element == nullptr || Trim(element->text).empty()) return std::nullopt;
  std::vector<double> times;
  const bool are_two = AppendDoubles(element->text, &times) && times.size() == 2;
  if (are_two && times[1] < 0) return std::nullopt;
  if (are_two && times[0] <= times[1]) return std::array<double, 2>{times[0], times[1]};
  throw Error(fmt::format("{}:{}: <time_range>: \"{:.60}\" is not two times, the earlier first",
                          file, element->line, element->text));
}

void TakeTasks(const XmlElement& owner, OsimToolSetup* setup) {
  const XmlElement* tasks = owner.FindChild("IKTaskSet");
  if (tasks == nullptr) return;
  const std::string* file = tasks->FindAttribute("file");
  if (file != nullptr && !Trim(*file).empty()) {
    setup->tasks_file = Trim(*file);
  } else {
    setup->has_tasks = tasks->FindChild("objects") != nullptr;
  }
}

/// The file of that name in a folder, whatever its case, as on Windows; empty: there is none.
std::string InFolder(const fs::path& folder, const std::string& name) {
  std::error_code failure;
  if (fs::exists(folder / name, failure)) return (folder / name).string();
  for (const std::string& other : NamesIn(folder.empty() ? "." : folder.string(), &failure)) {
    if (EqualIgnoringCase(other, name)) return (folder / other).string();
  }
  return "";
}

}  // namespace

bool IsOsimToolSetup(std::string_view content) {
  const std::string_view root = RootName(content);
  if (std::any_of(std::begin(kTools), std::end(kTools),
                  [&](const char* name) { return EqualIgnoringCase(root, name); })) {
    return true;
  }
  if (!IsOsimDocument(content)) return false;
  const std::string text = ToLower(content);
  return std::any_of(std::begin(kTools), std::end(kTools), [&](const char* name) {
    return text.find('<' + ToLower(name)) != std::string::npos;
  });
}

OsimToolSetup ParseOsimToolSetup(std::string_view content, const std::string& file) {
  const XmlElement root = ParseXml(FirstElement(content), file);
  const XmlElement* tool = FindTool(root);
  if (tool == nullptr) {
    throw Error(
        fmt::format("{}:{}: <{}> holds no <InverseKinematicsTool>, <ScaleTool> or "
                    "<InverseDynamicsTool>",
                    file, root.line, root.name.substr(0, 40)));
  }
  OsimToolSetup setup;
  setup.tool = tool->name;
  if (!tool->Is("ScaleTool")) {
    setup.model_file = FileOf(*tool, "model_file");
    setup.marker_file = FileOf(*tool, "marker_file");
    setup.coordinates_file = FileOf(*tool, "coordinates_file");
    setup.loads_file = FileOf(*tool, "external_loads_file");
    setup.time_range = TimesOf(*tool, file);
    TakeTasks(*tool, &setup);
    return setup;
  }
  if (const XmlElement* maker = tool->FindChild("GenericModelMaker")) {
    setup.model_file = FileOf(*maker, "model_file");
    setup.marker_set_file = FileOf(*maker, "marker_set_file");
  }
  if (const XmlElement* scaler = tool->FindChild("ModelScaler")) {
    setup.marker_file = FileOf(*scaler, "marker_file");
    setup.time_range = TimesOf(*scaler, file);
  }
  if (const XmlElement* placer = tool->FindChild("MarkerPlacer")) {
    const std::string standing = FileOf(*placer, "marker_file");
    if (!standing.empty()) setup.marker_file = standing;
    if (const auto times = TimesOf(*placer, file)) setup.time_range = times;
    TakeTasks(*placer, &setup);
  }
  return setup;
}

std::string FindFileOfSetup(const std::string& setup_file, const std::string& named,
                            const char* what, Warnings* warnings) {
  std::string text = named;
  std::replace(text.begin(), text.end(), '\\', '/');
  const fs::path folder = fs::path(setup_file).parent_path();
  const fs::path path = text;
  std::error_code failure;
  const bool has_drive = text.size() > 1 && text[1] == ':';
  const fs::path from_there = path.is_absolute() ? path : folder / path;
  if (!has_drive && fs::exists(from_there, failure)) return from_there.string();
  std::string found = has_drive ? "" : InFolder(from_there.parent_path(), path.filename().string());
  if (!found.empty()) return found;
  found = InFolder(folder, path.filename().string());
  if (found.empty()) {
    throw Error(fmt::format("{}: names the {} {}, which is neither there nor beside the set-up",
                            setup_file, what, named));
  }
  Warn(warnings, fmt::format("{} names the {} {}, which is not there; {} is taken", setup_file,
                             what, named, found));
  return found;
}

}  // namespace mmm_converter
