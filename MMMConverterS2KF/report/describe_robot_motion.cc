// SPDX-License-Identifier: MIT
// Motions of robots, as files of robot learning have them.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "MMMConverterS2KF/report/describe.h"
#include "common/io/bytes/file_content.h"
#include "common/support/error.h"
#include "common/support/line_file.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kRootColumns = 7;
constexpr double kUnitLength = 0.01;  // that a quaternion of four decimals is off

/// Root and joints of the first row, where the root's quaternion is one.
std::optional<std::size_t> ColumnsOfLafan(std::string_view head) {
  std::vector<double> row;
  for (const std::string& cell : Split(head.substr(0, head.find('\n')), ',')) {
    const auto number = ParseDouble(Trim(cell));
    if (!number || !std::isfinite(*number)) return {};
    row.push_back(*number);
  }
  if (row.size() <= kRootColumns) return {};
  const double length = std::hypot(std::hypot(row[3], row[4]), std::hypot(row[5], row[6]));
  if (std::abs(length - 1) > kUnitLength) return {};
  return row.size();
}

/// What export-lafan1 writes beside it; null: it is not there.
Json NamesBeside(const std::string& path) {
  constexpr std::size_t kMostBytes = std::size_t{1} << 20;
  const std::string file = path + ".names.json";
  if (!std::filesystem::is_regular_file(file)) return {};
  try {
    const Json names = ParseJson(ReadFileContent(file, kMostBytes));
    return names.is_object() ? names : Json();
  } catch (const Error&) {  // names that can't be read are none
    return {};
  }
}

std::vector<std::string> JointsOf(const Json& names, std::size_t count) {
  std::vector<std::string> joints;
  if (!names.contains("joints") || !names["joints"].is_array()) return joints;
  for (const Json& joint : names["joints"]) {
    if (joint.is_string()) joints.push_back(joint.get<std::string>());
  }
  return joints.size() == count ? joints : std::vector<std::string>();
}

struct PickleKind {
  const char* key;
  const char* name;
};
constexpr PickleKind kPickles[] = {
    {"root_trans_offset", "motions of a robot, as PHC and ASAP have them"},
    {"root_pos", "motion of a robot, as GMR and TWIST have it"},
};

const char* NameOfPickle(std::string_view head) {
  for (const PickleKind& kind : kPickles) {
    if (head.find(kind.key) != std::string_view::npos) return kind.name;
  }
  return "something that is not known";
}

}  // namespace

bool IsLafanTable(const FileStart& file) { return ColumnsOfLafan(file.head).has_value(); }

Description DescribeLafanTable(const FileStart& file, const ReadRecordingOptions&) {
  const std::size_t joints = *ColumnsOfLafan(file.head) - kRootColumns;
  long frames = 0;
  ForEachLine(file.path, [&](std::string_view line) { frames += Trim(line).empty() ? 0 : 1; });
  const Json beside = NamesBeside(file.path);
  const std::vector<std::string> names = JointsOf(beside, joints);
  return {fmt::format("{}: motion of a robot, as Unitree's LAFAN1 files have it (CSV without a "
                      "header; x y z, qx qy qz qw, joints)\nframes     {}\njoints     {}{}\n",
                      file.path, frames, joints, names.empty() ? "" : ": " + FirstNames(names)),
          FormatJson({{"kind", "robot motion"},
                      {"file", file.path},
                      {"of", "lafan1"},
                      {"frames", frames},
                      {"joints", joints},
                      {"names", names}}),
          {}};
}

bool IsPickle(const FileStart& file) {
  constexpr char kProtocol = '\x80', kFirst = 2, kLast = 5;  // of Python's versions of pickles
  return file.head.size() > 2 && file.head[0] == kProtocol && file.head[1] >= kFirst &&
         file.head[1] <= kLast;
}

Description DescribePickle(const FileStart& file, const ReadRecordingOptions&) {
  const char* const name = NameOfPickle(file.head);
  return {fmt::format("{}: pickle of Python with {}; it is not read, as reading one may run what "
                      "is in it\n",
                      file.path, name),
          FormatJson({{"kind", "pickle"}, {"file", file.path}, {"of", name}}),
          {}};
}

}  // namespace mmm_converter
