// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "MMMConverterS2KF/batch/manifest.h"
#include "MMMConverterS2KF/commands/commands.h"
#include "MMMConverterS2KF/commands/request_options.h"
#include "MMMConverterS2KF/live/motion_journal.h"
#include "MMMConverterS2KF/report/file_kinds.h"
#include "MMMConverterS2KF/report/json.h"
#include "MMMConverterS2KF/report/version.h"
#include "MMMConverterS2KF/terminal/command_line.h"
#include "MMMConverterS2KF/terminal/log.h"
#include "common/support/error.h"
#include "common/support/line_file.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

bool IsLiveJournal(const FileStart& file) { return file.head.starts_with("{\"journal\":"); }

Description DescribeLiveJournal(const FileStart& file, const ReadRecordingOptions&) {
  Description description;
  const JournalContent content = ReadJournal(file.path, &description.warnings);
  const JournalHeader& header = content.header;
  const MarkerSequence& markers = content.markers;
  const double seconds = content.frames > 0 ? markers.num_frames() / markers.rate() : 0;
  description.text = fmt::format(
      "{}: journal of a live motion that is coming, or whose process was killed\n", file.path);
  if (content.frames == 0) {
    description.text += "motion     no frame was tracked; there is nothing to recover\n";
  } else {
    description.text += fmt::format(
        "motion     {}, {} frames in {:.1f} s\n"
        "recover    the next live run with -o {} writes it beside that file first; for instance\n"
        "           MMMConverterS2KF live SOURCE -o {}\n",
        header.motion.motion_name, content.frames, seconds, header.output, header.output);
  }
  description.json = FormatJson({{"kind", "live journal"},
                                 {"file", file.path},
                                 {"motion", header.motion.motion_name},
                                 {"output", header.output},
                                 {"frames", content.frames},
                                 {"seconds", Number(seconds)},
                                 {"warnings", description.warnings.texts()}});
  return description;
}

/// What live tracking leaves behind: journals, with how their motion is recovered.
const std::vector<FileKind>& LiveFileKinds() {
  static const std::vector<FileKind> kKinds = {
      {"journals of live motions", IsLiveJournal, DescribeLiveJournal}};
  return kKinds;
}

bool IsManifest(const FileStart& file) { return EqualIgnoringCase(file.root, "Batch"); }

/// The first line; of a file that has none yet, what there is.
std::string_view FirstLine(const FileStart& file) {
  return std::string_view(file.head).substr(0, file.head.find('\n'));
}

bool IsJournal(const FileStart& file) {
  return FirstLine(file).starts_with("{\"id\":") &&
         FirstLine(file).find("\"fingerprint\":") != std::string_view::npos;
}

bool IsResults(const FileStart& file) {
  return FirstLine(file).starts_with("{\"id\":") &&
         FirstLine(file).find("\"state\":") != std::string_view::npos;
}

Description DescribeManifest(const FileStart& file, const ReadRecordingOptions&) {
  const BatchManifest manifest = ReadManifest(file.path);
  std::map<std::string, int> groups;
  Json entries = Json::array();
  for (const BatchEntry& entry : manifest.entries) {
    ++groups[entry.group];
    entries.push_back(
        {{"id", entry.id}, {"group", entry.group}, {"recording", entry.request.input.file}});
  }
  std::string text =
      fmt::format("{}: manifest of a batch\nname       {}\nrecordings {}\ngroups     {}\n",
                  file.path, manifest.name, manifest.entries.size(), groups.size());
  Json persons = Json::array();
  for (const auto& [id, person] : manifest.persons) persons.push_back(id);
  if (!persons.empty()) text += fmt::format("persons    {}\n", persons.size());
  for (const auto& [group, count] : groups) {
    text += fmt::format("  {:>6} in {}\n", count, group.empty() ? "no group" : group);
  }
  return {text,
          FormatJson({{"kind", "manifest"},
                      {"file", file.path},
                      {"name", manifest.name},
                      {"persons", persons},
                      {"recordings", entries}}),
          {}};
}

std::string TextOf(const Json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

/// null: it can't be understood.
Json ParseLine(std::string_view text) {
  try {
    return ParseJson(text);
  } catch (const Error&) {
    return nullptr;
  }
}

/// "converted", "failed", ...; empty where a line is not understood. A journal's lines have the
/// state in their result.
std::string StateOf(const Json& line) {
  if (!line.is_object()) return "";
  const auto result = line.find("result");
  return TextOf(result != line.end() && result->is_object() ? *result : line, "state");
}

/// Lines of JSON, of which an entry's last one counts.
Description DescribeLines(const FileStart& file, const char* kind, const char* title) {
  std::map<std::string, std::string> states;  // by id
  long lines = 0;
  long unclear = 0;
  ForEachLine(file.path, [&](std::string_view text) {
    ++lines;
    const Json line = ParseLine(text);
    const std::string state = StateOf(line);
    const std::string id = state.empty() ? "" : TextOf(line, "id");
    if (id.empty()) {
      ++unclear;
    } else {
      states[id] = state;
    }
  });
  Json counts = Json::object();
  for (const auto& [id, state] : states) {
    counts[state] = counts.value(state, 0) + 1;
  }
  std::string text =
      fmt::format("{}: {}\nlines      {}\nrecordings {}\n", file.path, title, lines, states.size());
  for (const auto& [state, count] : counts.items()) {
    text += fmt::format("{:<10} {}\n", state, count.get<int>());
  }
  Warnings warnings;
  if (unclear > 0) {
    warnings.Add(fmt::format("{}: {} lines are not understood", file.path, unclear));
  }
  return {text,
          FormatJson({{"kind", kind},
                      {"file", file.path},
                      {"lines", lines},
                      {"recordings", states.size()},
                      {"states", counts},
                      {"warnings", warnings.texts()}}),
          warnings};
}

Description DescribeJournal(const FileStart& file, const ReadRecordingOptions&) {
  return DescribeLines(file, "journal", "journal of a batch");
}

Description DescribeResults(const FileStart& file, const ReadRecordingOptions&) {
  return DescribeLines(file, "results", "results of a batch");
}

/// What a batch reads and writes: manifests, journals and results.
const std::vector<FileKind>& BatchFileKinds() {
  static const std::vector<FileKind> kKinds = {
      {"manifests", IsManifest, DescribeManifest},
      {"journals", IsJournal, DescribeJournal},
      {"results of batches", IsResults, DescribeResults},
  };
  return kKinds;
}

const OptionGroup kInfoOptions = {
    "Options",
    {{"json", "", "machine-readable", ""}, {"version", "", "print this program's version", ""}}};

constexpr const char* kInfoUsage = R"(MMMConverterS2KF info FILE [--json]
What is in a file that this program reads or writes: recordings (C3D, TRC), MMM motions, models,
robots (URDF, MJCF), configurations, marker sets, subjects, persons, plugins, manifests, journals
and results of a batch, summaries, tables (CSV, MOT) and pages. Of a C3D file also analog channels,
force plates, events and parameters; it need not have markers.

{}Examples
  MMMConverterS2KF info walk.c3d
  MMMConverterS2KF info xml_config/models/mmm.xml --json
  MMMConverterS2KF info lib/MMMConverterS2KF/plugins/S2KFConverter.so
)";

}  // namespace

Manual InfoManual() { return {kInfoUsage, CommandOptions(task::kInfo, {kInfoOptions})}; }

int RunInfo(const Arguments& arguments) {
  if (arguments.Has("version")) {
    std::cout << VersionText();
    return 0;
  }
  if (!arguments.positional()) {
    throw UsageError("info: which file? For instance: MMMConverterS2KF info walk.c3d");
  }
  StartLog(arguments.Get("log").value_or("info"));
  const ConversionRequest request = MakeRequest(task::kInfo, arguments, *arguments.positional());
  std::vector<FileKind> kinds = BatchFileKinds();
  kinds.insert(kinds.end(), LiveFileKinds().begin(), LiveFileKinds().end());
  kinds.insert(kinds.end(), FileKinds().begin(), FileKinds().end());
  const Description description = DescribeFile(request.input.file, request.input.reading, kinds);
  LogWarnings(description.warnings);
  std::cout << (arguments.Has("json") ? description.json : description.text);
  return 0;
}

}  // namespace mmm_converter
