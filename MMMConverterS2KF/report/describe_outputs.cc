// SPDX-License-Identifier: MIT
// What is in files that the program writes for other programs and for people.

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "MMMConverterS2KF/report/describe.h"
#include "common/io/bytes/file_content.h"
#include "common/support/error.h"
#include "common/support/line_file.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kMostJsonBytes = std::size_t{256} << 20;

/// A table of which the first line starts so.
struct TableKind {
  const char* start;
  const char* name;
  char separator;
  const char* header_end;  ///< the line before the names of the columns; empty: there is none
};

constexpr TableKind kTables[] = {
    {"time_s,root_x_mm", "postures (CSV)", ',', ""},
    {"time_s,", "poses of a body (CSV)", ',', ""},
    {"Coordinates", "postures for OpenSim (MOT)", '\t', "endheader"},
    {"id,state,reason,recording", "results of a batch (CSV)", ',', ""},
    {"recording,configuration,", "comparison of converters (CSV)", ',', ""},
    {"folder,", "subjects of recordings, for batch --scan (CSV)", ',', ""},
    {"file,", "subjects of recordings, for batch --scan (CSV)", ',', ""},
};

const TableKind* FindTable(std::string_view head) {
  if (head.starts_with("\xEF\xBB\xBF")) head.remove_prefix(3);
  const auto* const found =
      std::find_if(std::begin(kTables), std::end(kTables),
                   [&](const TableKind& kind) { return head.starts_with(kind.start); });
  return found == std::end(kTables) ? nullptr : found;
}

/// Of a file that is not empty.
bool EndsWithItsLine(const std::string& path) {
  const ByteSource bytes = BytesOfFile(path);
  char last = '\0';
  bytes.read(bytes.size - 1, 1, &last);
  return last == '\n';
}

/// Which of the program's summaries has such members.
struct SummaryKind {
  std::vector<const char*> members;
  const char* name;
};

const std::vector<SummaryKind>& SummaryKinds() {
  static const std::vector<SummaryKind> kKinds = {
      {{"input", "frames", "converter", "markers"}, "summary of a conversion"},
      {{"output", "motions"}, "summary of conversions"},
      {{"recordings", "calibration", "subject"}, "summary of a calibration"},
      {{"trials", "contenders", "rows"}, "comparison of converters"},
      {{"contacts", "checks", "verdict"}, "summary of a motion's dynamics"},
      {{"names", "unnamed", "changes"}, "summary of labels"},
      {{"kind", "file"}, "description of a file"},
  };
  return kKinds;
}

const char* SummaryName(const Json& json) {
  for (const SummaryKind& kind : SummaryKinds()) {
    if (std::all_of(kind.members.begin(), kind.members.end(),
                    [&](const char* member) { return json.contains(member); })) {
      return kind.name;
    }
  }
  return "JSON of no known kind";
}

Json ReadJson(const std::string& path) {
  const std::string content = ReadFileContent(path, kMostJsonBytes);
  try {
    return ParseJson(content);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path, error.what()));
  }
}

/// A member of a summary in a few words.
std::string Shortly(const Json& value) {
  constexpr std::size_t kMostCharacters = 200;
  if (value.is_array()) return fmt::format("{} entries", value.size());
  if (value.is_object()) return fmt::format("{} members", value.size());
  if (value.is_null()) return "none";
  const std::string text = value.is_string() ? value.get<std::string>() : FormatJsonLine(value);
  return text.size() > kMostCharacters ? text.substr(0, kMostCharacters) + "..." : text;
}

/// The title of a page, with what HTML escapes as it stands.
std::string Title(std::string_view head) {
  const std::size_t begin = head.find("<title>");
  const std::size_t end = head.find("</title>");
  if (begin == std::string_view::npos || end == std::string_view::npos || end < begin) return "";
  return std::string(head.substr(begin + 7, end - begin - 7));
}

}  // namespace

bool IsTable(const FileStart& file) { return FindTable(file.head) != nullptr; }

Description DescribeTable(const FileStart& file, const ReadRecordingOptions&) {
  const TableKind& kind = *FindTable(file.head);
  bool is_header = *kind.header_end != '\0';
  std::vector<std::string> columns;
  long rows = 0;
  bool is_in_quotes = false;
  ForEachLine(file.path, [&](std::string_view line) {
    if (line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
    if (is_header) {
      is_header = Trim(line) != kind.header_end;
    } else if (columns.empty()) {
      columns = Split(line, kind.separator);
    } else if (!Trim(line).empty()) {
      // A field in quotes may have line ends.
      is_in_quotes ^= std::count(line.begin(), line.end(), '"') % 2 != 0;
      if (!is_in_quotes) ++rows;
    }
  });
  if (!columns.empty() && !EndsWithItsLine(file.path)) ++rows;
  return {fmt::format("{}: table of {}\nrows       {}\ncolumns    {}: {}\n", file.path, kind.name,
                      rows, columns.size(), FirstNames(columns)),
          FormatJson({{"kind", "table"},
                      {"file", file.path},
                      {"of", kind.name},
                      {"rows", rows},
                      {"columns", columns}}),
          {}};
}

Description DescribeSummary(const FileStart& file, const ReadRecordingOptions&) {
  const Json content = ReadJson(file.path);
  const char* const name = SummaryName(content);
  Json members = Json::object();
  constexpr std::size_t kWidest = 32;
  std::size_t width = 10;
  for (const auto& [key, value] : content.items()) {
    width = std::clamp(key.size(), width, kWidest);
  }
  std::string text = fmt::format("{}: {}\n", file.path, name);
  for (const auto& [key, value] : content.items()) {
    text += fmt::format("{:<{}} {}\n", key, width, Shortly(value));
    members[key] = value.is_structured() ? Json(value.size()) : value;
  }
  return {
      text,
      FormatJson({{"kind", "summary"}, {"file", file.path}, {"of", name}, {"members", members}}),
      {}};
}

Description DescribePage(const FileStart& file, const ReadRecordingOptions&) {
  constexpr const char* kData = "<script type=\"application/json\" class=\"";
  if (file.head.find("<p id=\"program\"") == std::string::npos &&
      file.head.find("Content-Security-Policy\" content=\"default-src 'none'") ==
          std::string::npos) {
    throw Error(fmt::format("{}: is a web page, but none of this program's", file.path));
  }
  std::vector<std::string> data;
  const std::size_t name_at = std::string_view(kData).size();
  ForEachLine(file.path, [&](std::string_view line) {
    const std::size_t at = line.find(kData);
    if (at == std::string_view::npos) return;
    line.remove_prefix(at + name_at);
    data.emplace_back(line.substr(0, line.find('"')));
  });
  const auto has = [&](const char* name) {
    return std::find(data.begin(), data.end(), name) != data.end();
  };
  const char* const name = has("batch")    ? "the index of a batch"
                           : has("series") ? "the dynamics of a motion"
                           : has("tracks") ? "motions on their recordings"
                                           : "nothing that is known";
  const auto parts = std::count(data.begin(), data.end(), "tracks");
  const std::string title = Title(file.head);
  return {fmt::format("{}: page (open it in a browser) of {}\ntitle      {}\nrecordings {}\n",
                      file.path, name, title, parts),
          FormatJson({{"kind", "page"},
                      {"file", file.path},
                      {"of", name},
                      {"title", title},
                      {"recordings", parts}}),
          {}};
}

Description DescribeSampleSet(const FileStart& file, const ReadRecordingOptions&) {
  const std::string line(
      Trim(file.head.substr(0, std::min<std::size_t>(file.head.find('\n'), 400))));
  return {fmt::format("{}: sample set of the filter\nwhat       {}\n", file.path, line),
          FormatJson({{"kind", "sample set"}, {"file", file.path}, {"what", line}}),
          {}};
}

}  // namespace mmm_converter
