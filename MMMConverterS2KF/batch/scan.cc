// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include "MMMConverterS2KF/batch/manifest.h"
#include "MMMConverterS2KF/batch/manifest_attributes.h"
#include "MMMConverterS2KF/batch/subjects_table.h"
#include "common/io/bytes/file_content.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/io/mmm/processor_config.h"
#include "common/io/recording/recording_formats.h"
#include "common/io/xml/xml_text.h"
#include "common/support/advice.h"
#include "common/support/error.h"
#include "common/support/folder.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;
using Texts = std::map<std::string, std::string>;

struct FoundRecording {
  std::string file;  // name in its folder
  Texts attributes, metadata;
};

// What is said of a person in an MMM motion; several people are nobody's.
Texts PersonOf(const std::string& motion, const std::string& file) {
  constexpr std::string_view kOpening = "<ModelProcessorConfig";
  constexpr std::string_view kClosing = "</ModelProcessorConfig>";
  std::set<Texts> people;
  for (std::size_t at = motion.find(kOpening); at != std::string::npos;
       at = motion.find(kOpening, at)) {
    const std::size_t end = motion.find(kClosing, at);
    if (end == std::string::npos) break;
    const BodySize config =
        ParseProcessorConfig(motion.substr(at, end + kClosing.size() - at), file);
    Texts person;
    if (config.height) person["height_m"] = fmt::format("{:g}", *config.height);
    if (config.mass) person["mass_kg"] = fmt::format("{:g}", *config.mass);
    if (config.hand_length)
      person["handLength_mm"] = fmt::format("{:g}", 1e3 * *config.hand_length);
    if (!person.empty()) people.insert(std::move(person));
    at = end;
  }
  return people.size() == 1 ? *people.begin() : Texts();
}

bool HasMarkers(const std::string& motion) {
  return motion.find("<MarkerPosition") != std::string::npos;
}

// Whether XML can hold a file's name.
bool CanBeWritten(std::string_view name) {
  constexpr std::string_view kAllowed = "\t\n\r";
  return IsUtf8(name) && std::none_of(name.begin(), name.end(), [&](char c) {
           return c >= 0 && c < ' ' && kAllowed.find(c) == std::string_view::npos;
         });
}

// A file's name as an attribute's value. Control characters are numbers: neither XML nor a terminal
// changes them then.
std::string FormatName(std::string_view name) {
  std::string text;
  while (!name.empty()) {
    const std::size_t length = Utf8Length(name);
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(name[i]); };
    if (length == 1 && (byte(0) < 0x20 || byte(0) == 0x7F)) {
      text += fmt::format("&#{};", byte(0));
    } else if (length == 2 && byte(0) == 0xC2 && byte(1) < 0xA0) {
      text += fmt::format("&#{};", byte(1));
    } else {
      text += EscapeXml(name.substr(0, length));
    }
    name.remove_prefix(length);
  }
  return text;
}

bool HoldsRecording(const fs::path& file) {
  try {
    return FindFormatOfContent(file.string()) != nullptr;
  } catch (const Error&) {  // no file of a recording is empty or can't be read
    return false;
  }
}

class Scanner {
 public:
  Scanner(const fs::path& folder, const std::string& subjects_file) : folder_(folder) {
    if (!subjects_file.empty()) {
      subjects_file_ = fs::absolute(subjects_file);
      rows_ = ReadSubjectsTable(subjects_file);
    }
  }

  Scan Run() {
    if (!CanBeWritten(folder_.string())) {
      throw Error(
          fmt::format("{}: has a name that is not UTF-8 or has control characters, which a "
                      "manifest can't hold; rename it",
                      folder_.string()));
    }
    Visit(folder_);
    for (const auto& [name, row] : rows_) {
      if (row.is_used) continue;
      scan_.warnings.Add(
          fmt::format("{}: there is no recording in or at \"{}\"", subjects_file_.string(), name));
    }
    if (scan_.recordings == 0) {
      throw Error(fmt::format("{}: has no recording ({} with markers)", folder_.string(),
                              RecordingFormatNames()));
    }
    scan_.manifest = fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<!-- {} recordings; all that may be said of them: MMMConverterS2KF print-config batch "
        "-->\n"
        "<Batch name=\"{}\" folder=\"{}\" config=\"s2kf_default\">\n{}</Batch>\n",
        scan_.recordings, EscapeXml(folder_.filename().string()), FormatName(folder_.string()),
        groups_);
    return std::move(scan_);
  }

 private:
  // Names in a folder, sorted; what can't be read is a warning.
  std::vector<fs::path> List(const fs::path& folder) {
    std::vector<fs::path> entries;
    std::error_code failure;
    for (const std::string& name : NamesIn(folder.string(), &failure)) {
      entries.push_back(folder / name);
    }
    if (failure) {
      scan_.warnings.Add(fmt::format("{}: can't be read: {}", folder.string(), failure.message()));
    }
    return entries;
  }

  void Visit(const fs::path& folder) {
    const std::vector<fs::path> entries = List(folder);
    std::vector<FoundRecording> recordings;
    std::set<std::string> measured;  // stems of files that are recordings only
    std::error_code failure;
    const auto take = [&](bool told_by_content) {
      for (const fs::path& entry : entries) {
        const RecordingFormat* format = FindFormatOfName(entry.string());
        if (!fs::is_regular_file(entry, failure) || format == nullptr || format->holds_motions ||
            format->is_told_by_content != told_by_content) {
          continue;
        }
        // A table is the export of the recording of the same name, where that is there.
        const std::string stem = entry.stem().string();
        if (told_by_content && (measured.contains(stem) || !HoldsRecording(entry))) continue;
        if (!HasNameForManifest(entry)) continue;
        recordings.push_back({entry.filename().string(), {}, {}});
        measured.insert(stem);
      }
    };
    take(false);
    take(true);
    for (const fs::path& entry : entries) {
      const RecordingFormat* format = FindFormatOfName(entry.string());
      if (!fs::is_regular_file(entry, failure) || format == nullptr || !format->holds_motions)
        continue;
      TakeMotion(entry, measured, &recordings);
    }
    Add(folder, std::move(recordings));
    for (const fs::path& entry : entries) {
      if (fs::is_directory(entry, failure) && !fs::is_symlink(entry, failure)) Visit(entry);
    }
  }

  bool HasNameForManifest(const fs::path& file) {
    if (CanBeWritten(file.lexically_relative(folder_).string())) return true;
    scan_.warnings.AddOfKind(
        "files that can't stand in a manifest",
        fmt::format("{}: is left out: its name is not UTF-8 or has control characters, which a "
                    "manifest can't hold; rename it",
                    file.string()));
    return false;
  }

  // An MMM motion: a recording, or of the person of the recordings of the same name.
  void TakeMotion(const fs::path& file, const std::set<std::string>& measured,
                  std::vector<FoundRecording>* recordings) {
    constexpr std::size_t kStart = 4096;
    const std::string stem = file.stem().string();
    try {
      if (!LooksLikeMmmMotion(ReadFileStart(file.string(), kStart))) return;
      const std::string content = ReadFileContent(file.string());
      if (measured.count(stem) > 0) {
        const Texts person = PersonOf(content, file.string());
        for (FoundRecording& recording : *recordings) {
          if (fs::path(recording.file).stem() == stem) recording.attributes = person;
        }
      } else if (HasMarkers(content) && !stem.ends_with("_mmm") && HasNameForManifest(file)) {
        recordings->push_back({file.filename().string(), {}, {}});
      }
    } catch (const Error& error) {
      scan_.warnings.Add(WithManifestAdvice(error));
    }
  }

  // The table's line for a folder or file; the table comes before MMM motions.
  void TakeRow(const std::string& name, FoundRecording* recording) {
    const auto found = rows_.find(name);
    if (found == rows_.end()) return;
    found->second.is_used = true;
    for (const auto& [key, value] : found->second.attributes) {
      const bool is_file = key == "subjectFile";
      recording->attributes[key] =
          is_file ? (subjects_file_.parent_path() / value).lexically_normal().string() : value;
    }
    for (const auto& [key, value] : found->second.metadata) recording->metadata[key] = value;
  }

  void Add(const fs::path& folder, std::vector<FoundRecording> recordings) {
    if (recordings.empty()) return;
    scan_.recordings += static_cast<int>(recordings.size());
    const fs::path relative = folder.lexically_relative(folder_);
    for (FoundRecording& recording : recordings) {
      TakeRow(relative.generic_string(), &recording);
      TakeRow((relative / recording.file).lexically_normal().generic_string(), &recording);
      TakeRow((relative / fs::path(recording.file).stem()).lexically_normal().generic_string(),
              &recording);
    }
    const Texts attributes = Common(recordings, &FoundRecording::attributes);
    const Texts metadata = Common(recordings, &FoundRecording::metadata);
    groups_ += fmt::format(
        "  <Group name=\"{}\"{}>\n",
        EscapeXml(relative == "." ? folder.filename().string() : relative.generic_string()),
        Format(attributes));
    groups_ += FormatMetadata("    ", metadata);
    for (const FoundRecording& recording : recordings) {
      const std::string file = (relative / recording.file).lexically_normal().generic_string();
      const Texts own = Without(recording.attributes, attributes);
      const Texts own_metadata = Without(recording.metadata, metadata);
      groups_ += fmt::format("    <Recording file=\"{}\"{}{}", FormatName(file),
                             Id(file, recordings), Format(own));
      groups_ += own_metadata.empty()
                     ? "/>\n"
                     : ">\n" + FormatMetadata("      ", own_metadata) + "    </Recording>\n";
    }
    groups_ += "  </Group>\n";
  }

  // For recordings that differ in their ending only, and for names that can't be those of outputs.
  std::string Id(const std::string& file, const std::vector<FoundRecording>& recordings) {
    const fs::path path(file);
    const auto has_stem = [&](const FoundRecording& other) {
      return fs::path(other.file).stem() == path.stem();
    };
    const std::string usual = (path.parent_path() / path.stem()).generic_string();
    const auto plainly = [](std::string id) {
      std::replace_if(
          id.begin(), id.end(), [](char c) { return (c >= 0 && c < ' ') || c == '\\'; }, '_');
      return id;
    };
    std::string plain = plainly(usual);
    const bool is_one_of_several =
        std::count_if(recordings.begin(), recordings.end(), has_stem) > 1;
    if (is_one_of_several) plain = plainly(file);
    if (!IsPlainId(plain)) plain = "recording";
    std::string id = plain;
    for (int i = 2; !ids_.insert(id).second; ++i) id = fmt::format("{}_{}", plain, i);
    return id == usual ? "" : " id=\"" + FormatName(id) + "\"";
  }

  // What all recordings have alike.
  static Texts Common(const std::vector<FoundRecording>& recordings, Texts FoundRecording::*texts) {
    Texts common;
    for (const auto& item : recordings.front().*texts) {
      const bool all_have =
          std::all_of(recordings.begin(), recordings.end(), [&](const FoundRecording& recording) {
            const auto found = (recording.*texts).find(item.first);
            return found != (recording.*texts).end() && found->second == item.second;
          });
      if (all_have) common.insert(item);
    }
    return common;
  }

  static Texts Without(const Texts& texts, const Texts& others) {
    Texts rest;
    for (const auto& item : texts) {
      if (others.count(item.first) == 0) rest.insert(item);
    }
    return rest;
  }

  static std::string Format(const Texts& attributes) {
    std::string text;
    for (const auto& [name, value] : attributes) {
      text += fmt::format(" {}=\"{}\"", name, EscapeXml(value));
    }
    return text;
  }

  static std::string FormatMetadata(const std::string& indent, const Texts& metadata) {
    std::string text;
    for (const auto& [name, value] : metadata) {
      text += fmt::format("{}<Metadata name=\"{}\" value=\"{}\"/>\n", indent, EscapeXml(name),
                          EscapeXml(value));
    }
    return text;
  }

  fs::path folder_;
  fs::path subjects_file_;
  std::map<std::string, SubjectsRow> rows_;
  Scan scan_;
  std::string groups_;
  std::set<std::string> ids_;
};

}  // namespace

Scan ScanFolder(const std::string& folder, const std::string& subjects_file) {
  std::error_code failure;
  const fs::path path = fs::canonical(folder, failure);
  if (failure || !fs::is_directory(path, failure)) {
    throw Error(fmt::format("{}: is no folder that can be read", folder));
  }
  return Scanner(path, subjects_file).Run();
}

}  // namespace mmm_converter
