// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/batch_file_kinds.h"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/batch/manifest.h"
#include "MMMConverterS2KF/report/json.h"
#include "common/support/error.h"
#include "common/support/line_file.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

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

}  // namespace

const std::vector<FileKind>& BatchFileKinds() {
  static const std::vector<FileKind> kKinds = {
      {"manifests", IsManifest, DescribeManifest},
      {"journals", IsJournal, DescribeJournal},
      {"results of batches", IsResults, DescribeResults},
  };
  return kKinds;
}

}  // namespace mmm_converter
