// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/manifest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <unordered_map>

#include "MMMConverterS2KF/batch/manifest_attributes.h"
#include "common/io/bytes/file_content.h"
#include "common/io/robot/robot_exports.h"
#include "common/io/xml/xml_document.h"
#include "common/support/diagnostics.h"
#include "common/support/error.h"
#include "common/support/suggestion.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

/// What a batch takes for a recording, and for each byte that is written of it or of a group around
/// it [bytes], measured, and what all may take.
constexpr double kBytesOfRecording = 4200;
constexpr double kBytesOfText = 5;
constexpr double kMostBytesOfByte = 16;
constexpr double kFreeManifestBytes = 512e6;

struct Needs {
  std::size_t recordings = 0;
  double bytes = 0;
};

/// Bytes of an element's attributes and of its <Metadata>.
double TextBytes(const XmlElement& element) {
  double bytes = 0;
  for (const auto& [name, value] : element.attributes) {
    bytes += static_cast<double>(name.size() + value.size());
  }
  for (const XmlElement& child : element.children) {
    if (child.name == "Metadata") bytes += TextBytes(child);
  }
  return bytes;
}

/// inherited: bytes of the elements around. A group is one more copy of them, until it ends.
void Add(const XmlElement& element, double inherited, Needs* needs) {
  const double text = inherited + TextBytes(element);
  needs->bytes += kBytesOfText * text;
  if (element.name == "Recording") ++needs->recordings;
  if (element.name == "Recording" || element.name == "Person") needs->bytes += kBytesOfRecording;
  for (const XmlElement& child : element.children) {
    if (child.name != "Metadata") Add(child, text, needs);
  }
}

/// How many recordings a manifest has.
/// @throws Error where they, with what they take over from their groups, would take much more
/// memory than the file of so many bytes.
std::size_t CountRecordings(const XmlElement& manifest, std::size_t file_bytes,
                            const std::string& file) {
  Needs needs;
  Add(manifest, 0, &needs);
  if (needs.bytes > kFreeManifestBytes + kMostBytesOfByte * static_cast<double>(file_bytes)) {
    throw Error(fmt::format(
        "{}: its {} recordings, with what their groups say of them, would take {:.0f} MB of "
        "memory; make several manifests of it, or say less in its groups",
        file, needs.recordings, 1e-6 * needs.bytes));
  }
  return needs.recordings;
}

namespace fs = std::filesystem;

constexpr std::size_t kLongestName = 240;  // of a file or folder [bytes]; most systems take 255
constexpr std::size_t kMaxManifestBytes = std::size_t{64} << 20;
constexpr std::size_t kMostRecordings = 1000;  // of a person

// Files with ; between them; without any ; with spaces.
std::vector<std::string> SplitFiles(std::string text) {
  if (text.find(';') == std::string::npos) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == ' ' || c == '\t' || c == '\n'; }, ';');
  }
  std::vector<std::string> files;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ';');) {
    if (!Trim(part).empty()) files.emplace_back(Trim(part));
  }
  return files;
}

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
    CollectPersons(root_);
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
      } else if (child.name == "Person") {
        ReadPerson(child, settings);
      } else if (child.name != "Metadata") {
        diagnostics_.AddError(
            child.line,
            fmt::format("unknown element <{}> in <{}>; use Group, Recording, Person or Metadata",
                        child.name, element.name));
      }
    }
  }

  // Those, too, that stand behind who names them.
  void CollectPersons(const XmlElement& element) {
    for (const XmlElement& child : element.children) {
      const std::string* id = child.name == "Person" ? child.FindAttribute("id") : nullptr;
      if (id != nullptr) persons_.insert(*id);
      CollectPersons(child);
    }
  }

  void ReadPerson(const XmlElement& element, const BatchEntry& around) {
    BatchPerson person;
    person.line = element.line;
    person.settings = ForCalibration(around);
    ApplyAttributes(element, {"id", "recordings"}, PersonAttributesOf(&person.settings),
                    &person.settings);
    for (const XmlElement& child : element.children) {
      diagnostics_.AddError(child.line, fmt::format("<Person> has no <{}>", child.name));
    }
    const std::string* id = element.FindAttribute("id");
    const std::string* files = element.FindAttribute("recordings");
    if (files != nullptr) person.recordings = SplitFiles(*files);
    if (id == nullptr || person.recordings.empty() || person.recordings.size() > kMostRecordings) {
      diagnostics_.AddError(
          element.line,
          fmt::format("<Person> needs id=\"...\" and recordings=\"...\", of 1 to {} files",
                      kMostRecordings));
      return;
    }
    for (std::string& file : person.recordings) {
      file = (recordings_ / file).lexically_normal().string();
    }
    person.settings.settings["recordings"] = *files;
    person.settings.request.input.file = person.recordings.front();
    person.id = person.settings.id = *id;
    CheckId(element.line, *id, "person", &person_lines_);
    manifest_.persons.emplace(*id, std::move(person));
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
    if (entry.request.robot.file.empty() && element.FindAttribute("robot") != nullptr) {
      for (const RobotExporter& exporter : RobotExporters()) entry.exports.erase(exporter.name);
    }
    CheckRobotExports(element, entry);
    entry.line = element.line;
    entry.request.input.file = (recordings_ / *file).lexically_normal().string();
    const std::string* id = element.FindAttribute("id");
    entry.id = id != nullptr ? *id : DefaultId(*file);
    CheckId(element.line, entry.id, "recording", &lines_);
    manifest_.entries.push_back(std::move(entry));
  }

  void CheckRobotExports(const XmlElement& element, const BatchEntry& entry) {
    const RobotRequest& robot = entry.request.robot;
    for (const char* idle : {"robotMap", "soleHeight_mm", "robotSole", "robotHold", "robotWeights",
                             "robotObjects", "robotRate_hz", "robotOrder"}) {
      if (!robot.file.empty() || element.FindAttribute(idle) == nullptr) continue;
      diagnostics_.AddError(element.line,
                            fmt::format("<Recording>: {} needs robot=\"FILE\"", idle));
    }
    for (const RobotExporter& exporter : RobotExporters()) {
      if (entry.exports.count(exporter.name) == 0) continue;
      const char* const lacks = robot.file.empty()                            ? "robot=\"FILE\""
                                : exporter.needs_order && robot.order.empty() ? "robotOrder"
                                                                              : nullptr;
      if (lacks == nullptr) continue;
      diagnostics_.AddError(element.line,
                            fmt::format("<Recording>: {}=\"true\" needs {}", exporter.name, lacks));
    }
  }

  // The file without its ending; without its folders too where these are not below the manifest's.
  static std::string DefaultId(const std::string& file) {
    const fs::path path = fs::path(file).lexically_normal();
    const bool is_below = path.is_relative() && !path.empty() && *path.begin() != "..";
    return (is_below ? path.parent_path() / path.stem() : path.stem()).generic_string();
  }

  void CheckId(int line, const std::string& id, const char* what,
               std::unordered_map<std::string, int>* lines) {
    if (!IsPlainId(id)) {
      diagnostics_.AddError(line,
                            fmt::format("id=\"{}\" names the outputs and must be a relative "
                                        "path without . and .., in UTF-8, of names of at most "
                                        "{} bytes, such as 1723/Cut",
                                        id, kLongestName));
    }
    const auto [found, is_new] = lines->emplace(id, line);
    if (is_new) return;
    diagnostics_.AddError(line, fmt::format("id=\"{}\" is that of the {} in line {} too; "
                                            "give one of them another id",
                                            id, what, found->second));
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

  void Apply(const XmlElement& element, const std::vector<std::string>& own, BatchEntry* settings) {
    ChoosePerson(element, settings);
    ApplyAttributes(element, own, AttributesOf(settings), settings);
    if (!settings->person.empty()) settings->request.input.person.processor_file.clear();
    ChooseSubject(element, settings);
  }

  void ApplyAttributes(const XmlElement& element, std::vector<std::string> own,
                       const std::vector<Option>& attributes, BatchEntry* settings) {
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
  }

  // A <Person> has its own size: what is said of it around its recordings is of others. What is no
  // id names a file (ModelProcessorConfig).
  void ChoosePerson(const XmlElement& element, BatchEntry* settings) {
    const std::string* person = element.FindAttribute("person");
    if (person == nullptr) return;
    settings->person.clear();
    if (persons_.count(*person) == 0) {
      if (IsMissingName(*person, folder_.string())) AddUnknownPerson(element, *person);
      return;
    }
    settings->person = *person;
    settings->request.input.person.size = {};
    for (const char* size : {"height_m", "mass_kg", "handLength_mm"}) {
      settings->settings.erase(size);
      if (element.FindAttribute(size) == nullptr) continue;
      diagnostics_.AddError(
          element.line,
          fmt::format("<{}>: {} is to be said of <Person id=\"{}\">", element.name, size, *person));
    }
  }

  void AddUnknownPerson(const XmlElement& element, const std::string& person) {
    const std::string closest = ClosestName(person, {persons_.begin(), persons_.end()});
    diagnostics_.AddError(
        element.line,
        fmt::format("<{}>: person=\"{}\" is neither the id of a <Person> nor a file{}",
                    element.name, person,
                    closest.empty() ? "" : "; did you mean " + closest + "?"));
  }

  // Says who the person is: the innermost element that estimates, names or gives one holds.
  void ChooseSubject(const XmlElement& element, BatchEntry* settings) {
    ConversionRequest* request = &settings->request;
    const std::string* person = element.FindAttribute("person");
    const bool is_of_manifest = person != nullptr && persons_.count(*person) > 0;
    const bool is_given = element.FindAttribute("subjectFile") != nullptr;
    const std::string* estimate = element.FindAttribute("selfCalibrate");
    const bool is_estimated = estimate != nullptr && *estimate == "true";
    if (is_given && is_estimated) {
      diagnostics_.AddError(element.line,
                            "selfCalibrate=\"true\" estimates the person, subjectFile "
                            "says who it is; use one");
    } else if (is_of_manifest && (is_given || is_estimated)) {
      diagnostics_.AddError(element.line,
                            fmt::format("person=\"{}\" says who it is; leave out subjectFile and "
                                        "selfCalibrate",
                                        *person));
    }
    if (is_given || is_of_manifest) request->self_calibrate = false;
    if (is_estimated || is_of_manifest) request->input.person.subject_file.clear();
    if (is_given || is_estimated) settings->person.clear();
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
  std::set<std::string> persons_;  // ids, of all
  std::unordered_map<std::string, int> lines_, person_lines_;
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
     <Person id="" recordings="">: a person who is calibrated once, by recordings with spaces or ;
     between them, for the recordings with person="ID"; FOLDER/persons/ID.xml. It has
     attributes for what the command calibrate has options for.
     <Metadata name="" value=""/> in any of them goes into the results as it is.  -->
<Batch name="example" config="s2kf_default">
  <Group name="1723" height_m="1.68" mass_kg="62">
    <Metadata name="session" value="2016-03-01"/>
    <Recording file="files_motions_1723/Cut.c3d"/>
    <Recording file="files_motions_1723/Peel.c3d" config="s2kf_offline" frames="100:"/>
  </Group>
  <Person id="anna" recordings="static.c3d range.c3d" height_m="1.75"/>
  <Recording file="run.c3d" person="anna"/>
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
