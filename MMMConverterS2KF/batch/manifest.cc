// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/manifest.h"

#include <fmt/format.h>

#include <filesystem>
#include <unordered_map>

#include "MMMConverterS2KF/batch/manifest_attributes.h"
#include "MMMConverterS2KF/batch/manifest_memory.h"
#include "common/io/bytes/file_content.h"
#include "common/io/xml/xml_document.h"
#include "common/support/diagnostics.h"
#include "common/support/suggestion.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestName = 240;  // of a file or folder [bytes]; most systems take 255
constexpr std::size_t kMaxManifestBytes = std::size_t{64} << 20;

class ManifestReader {
 public:
  ManifestReader(const XmlElement& root, std::size_t bytes, const std::string& file)
      : root_(root), bytes_(bytes), folder_(fs::path(file).parent_path()), diagnostics_(file) {}

  BatchManifest Read() {
    if (root_.name != "Batch") {
      throw Error(
          fmt::format("{}:{}: this is a <{}> file; a manifest starts with <Batch>; print one with "
                      "print-config batch, or with batch --scan FOLDER",
                      diagnostics_.file(), root_.line, root_.name));
    }
    manifest_.entries.reserve(CountRecordings(root_, bytes_, diagnostics_.file()));
    manifest_.file = diagnostics_.file();
    recordings_ = folder_;
    if (const std::string* folder = root_.FindAttribute("folder")) recordings_ = folder_ / *folder;
    BatchEntry defaults;
    Apply(root_, {"name", "folder"}, &defaults);
    if (const std::string* name = root_.FindAttribute("name")) manifest_.name = *name;
    if (manifest_.name.empty()) manifest_.name = fs::path(manifest_.file).stem().string();
    ReadChildren(root_, defaults);
    if (manifest_.entries.empty() && diagnostics_.errors().empty()) {
      diagnostics_.AddError(root_.line, "<Batch> has no <Recording file=\"...\"/>");
    }
    diagnostics_.ThrowIfErrors();
    return std::move(manifest_);
  }

 private:
  // Metadata first: they hold for all recordings of their element, also for those before them.
  void ReadChildren(const XmlElement& element, BatchEntry settings) {
    for (const XmlElement& child : element.children) {
      if (child.name == "Metadata") ReadMetadata(child, &settings);
    }
    for (const XmlElement& child : element.children) {
      if (child.name == "Recording") {
        ReadRecording(child, settings);
      } else if (child.name == "Group") {
        ReadGroup(child, settings);
      } else if (child.name != "Metadata") {
        diagnostics_.AddError(
            child.line,
            fmt::format("unknown element <{}> in <{}>; use Group, Recording or Metadata",
                        child.name, element.name));
      }
    }
  }

  void ReadGroup(const XmlElement& element, BatchEntry settings) {
    Apply(element, {"name"}, &settings);
    if (const std::string* name = element.FindAttribute("name")) {
      settings.group += (settings.group.empty() ? "" : " / ") + *name;
    }
    ReadChildren(element, std::move(settings));
  }

  void ReadRecording(const XmlElement& element, BatchEntry entry) {
    Apply(element, {"file", "id"}, &entry);
    for (const XmlElement& child : element.children) {
      if (child.name == "Metadata") {
        ReadMetadata(child, &entry);
      } else {
        diagnostics_.AddError(
            child.line,
            fmt::format("unknown element <{}> in <Recording>; use Metadata", child.name));
      }
    }
    const std::string* file = element.FindAttribute("file");
    if (file == nullptr || file->empty()) {
      diagnostics_.AddError(element.line, "<Recording> needs file=\"...\"");
      return;
    }
    entry.line = element.line;
    entry.request.input.file = (recordings_ / *file).lexically_normal().string();
    const std::string* id = element.FindAttribute("id");
    entry.id = id != nullptr ? *id : DefaultId(*file);
    CheckId(element.line, entry.id);
    manifest_.entries.push_back(std::move(entry));
  }

  // The file without its ending; without its folders too where these are not below the manifest's.
  static std::string DefaultId(const std::string& file) {
    const fs::path path = fs::path(file).lexically_normal();
    const bool is_below = path.is_relative() && !path.empty() && *path.begin() != "..";
    return (is_below ? path.parent_path() / path.stem() : path.stem()).generic_string();
  }

  void CheckId(int line, const std::string& id) {
    if (!IsPlainId(id)) {
      diagnostics_.AddError(line,
                            fmt::format("id=\"{}\" names the outputs and must be a relative "
                                        "path without . and .., in UTF-8, of names of at most "
                                        "{} bytes, such as 1723/Cut",
                                        id, kLongestName));
    }
    const auto [found, is_new] = lines_.emplace(id, line);
    if (is_new) return;
    diagnostics_.AddError(line, fmt::format("id=\"{}\" is that of the recording in line {} too; "
                                            "give one of them another id",
                                            id, found->second));
  }

  void ReadMetadata(const XmlElement& element, BatchEntry* settings) {
    CheckNames(element, {"name", "value"});
    const std::string* name = element.FindAttribute("name");
    const std::string* value = element.FindAttribute("value");
    if (name == nullptr || name->empty() || value == nullptr) {
      diagnostics_.AddError(element.line, "<Metadata> needs name=\"...\" and value=\"...\"");
      return;
    }
    settings->metadata[*name] = *value;
  }

  void Apply(const XmlElement& element, std::vector<std::string> own, BatchEntry* settings) {
    const std::vector<Option> attributes = AttributesOf(settings);
    for (const Option& attribute : attributes) own.emplace_back(attribute.names.attribute);
    CheckNames(element, own);
    for (const Option& attribute : attributes) {
      const std::string name = attribute.names.attribute;
      const std::string* value = element.FindAttribute(name);
      if (value == nullptr) continue;
      settings->settings[name] = *value;
      const std::string expected = ReadAttribute(attribute, *value, folder_.string());
      if (expected.empty()) continue;
      diagnostics_.AddError(element.line, fmt::format("<{}>: {}=\"{}\" is not allowed; {}",
                                                      element.name, name, *value, expected));
    }
    ChooseSubject(element, &settings->request);
  }

  // Of a subject that is estimated and one that is given the innermost holds.
  void ChooseSubject(const XmlElement& element, ConversionRequest* request) {
    const bool is_given = element.FindAttribute("subjectFile") != nullptr;
    const std::string* estimate = element.FindAttribute("selfCalibrate");
    const bool is_estimated = estimate != nullptr && *estimate == "true";
    if (is_given && is_estimated) {
      diagnostics_.AddError(element.line,
                            "selfCalibrate=\"true\" estimates the person, subjectFile "
                            "says who it is; use one");
    } else if (is_given) {
      request->self_calibrate = false;
    } else if (is_estimated) {
      request->input.person.subject_file.clear();
    }
  }

  void CheckNames(const XmlElement& element, const std::vector<std::string>& names) {
    for (const std::string& attribute : element.AttributesBeside(names)) {
      const std::string closest = ClosestName(attribute, names);
      diagnostics_.AddError(element.line,
                            fmt::format("<{}>: unknown attribute {}; {}", element.name, attribute,
                                        closest.empty() ? "use " + JoinNames(names)
                                                        : "did you mean " + closest + "?"));
    }
  }

  const XmlElement& root_;
  std::size_t bytes_;    // of the file
  fs::path folder_;      // of the manifest
  fs::path recordings_;  // where their files start
  Diagnostics diagnostics_;
  BatchManifest manifest_;
  std::unordered_map<std::string, int> lines_;
};

constexpr const char* kTemplate = R"(<?xml version="1.0" encoding="UTF-8"?>
<!-- A batch: recordings to convert, for  MMMConverterS2KF batch THIS_FILE -o FOLDER

     An attribute of <Batch> or <Group> holds for every recording inside; of several, the innermost.
     Files are relative to this one. Attributes of <Batch>, <Group> and <Recording>:

{}
     <Batch name="" folder="">: folder is where the recordings' files start, this file's without it.
     <Group name="">: groups may stand in groups; the name goes into the results.
     <Recording file="" id="">: id names the outputs, FOLDER/motions/ID.xml; the file without its
     ending where it is not there.
     <Metadata name="" value=""/> in any of them goes into the results as it is.  -->
<Batch name="example" config="s2kf_default">
  <Group name="1723" height_m="1.68" mass_kg="62">
    <Metadata name="session" value="2016-03-01"/>
    <Recording file="files_motions_1723/Cut.c3d"/>
    <Recording file="files_motions_1723/Peel.c3d" config="s2kf_offline" frames="100:"/>
  </Group>
  <Recording file="walk.c3d" id="walking/first" height_m="1.80" selfCalibrate="true"/>
</Batch>
)";

}  // namespace

BatchManifest ReadManifest(const std::string& path) {
  return ParseManifest(ReadFileContent(path, kMaxManifestBytes), path);
}

BatchManifest ParseManifest(const std::string& xml, const std::string& file) {
  const XmlElement root = ParseXml(xml, file);
  return ManifestReader(root, xml.size(), file).Read();
}

bool IsPlainId(const std::string& id) {
  const fs::path path(id);
  return !id.empty() && path.is_relative() && id == path.lexically_normal().string() &&
         path.has_filename() && *path.begin() != ".." && *path.begin() != "." && IsUtf8(id) &&
         std::none_of(path.begin(), path.end(),
                      [](const fs::path& part) { return part.native().size() > kLongestName; }) &&
         std::none_of(id.begin(), id.end(),
                      [](char c) { return (c >= 0 && c < ' ') || c == '\\'; });
}

std::string ManifestTemplate() { return fmt::format(kTemplate, DescribeAttributes()); }

std::vector<const BatchEntry*> ShardOf(const std::vector<BatchEntry>& entries, int shard,
                                       int shards) {
  std::vector<const BatchEntry*> part;
  for (std::size_t i = shard - 1; i < entries.size(); i += shards) part.push_back(&entries[i]);
  return part;
}

}  // namespace mmm_converter
