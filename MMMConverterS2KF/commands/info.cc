// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <iostream>

#include "MMMConverterS2KF/batch/batch_file_kinds.h"
#include "MMMConverterS2KF/commands/commands.h"
#include "MMMConverterS2KF/report/file_kinds.h"
#include "MMMConverterS2KF/report/version.h"
#include "MMMConverterS2KF/terminal/command_line.h"
#include "MMMConverterS2KF/terminal/log.h"

namespace mmm_converter {
namespace {

const std::vector<OptionGroup> kOptions = {
    {"Options",
     {{"json", "", "machine-readable", ""},
      {"subject", "NAME", "label prefix of the subject, if a recording has several", ""},
      {"unit", "mm|cm|m|in", "overrides the unit that the file states", ""},
      {"up", "AXIS", "the recording's axis that points up: x, y, z, -x, -y or -z", ""},
      {"log", "LEVEL", "off, error, warning, info or debug; default: info", ""},
      {"version", "", "print this program's version", ""},
      {"help,h", "", "print this help", ""}}}};

constexpr const char* kUsage = R"(MMMConverterS2KF info FILE [--json]
What is in a file that this program reads or writes: recordings (C3D, TRC), MMM motions, models and
URDF, configurations, marker sets, subjects, persons, plugins, manifests, journals and results of a
batch, summaries, tables (CSV, MOT) and pages. Of a C3D file also analog channels, force plates,
events and parameters; it need not have markers.

{}Examples
  MMMConverterS2KF info walk.c3d
  MMMConverterS2KF info xml_config/models/mmm.xml --json
  MMMConverterS2KF info lib/MMMConverterS2KF/plugins/S2KFConverter.so
)";

}  // namespace

Manual InfoManual() { return {kUsage, kOptions}; }

int RunInfo(const Arguments& arguments) {
  if (arguments.Has("version")) {
    std::cout << VersionText();
    return 0;
  }
  if (!arguments.positional()) {
    throw UsageError("info: which file? For instance: MMMConverterS2KF info walk.c3d");
  }
  StartLog(arguments.Get("log").value_or("info"));
  ReadRecordingOptions options;
  options.subject = arguments.Get("subject").value_or("");
  options.unit = arguments.Get("unit");
  if (const auto axis = arguments.Get("up")) options.up_axis = ParseUpAxis(*axis);
  std::vector<FileKind> kinds = BatchFileKinds();
  kinds.insert(kinds.end(), FileKinds().begin(), FileKinds().end());
  const Description description = DescribeFile(*arguments.positional(), options, kinds);
  LogWarnings(description.warnings);
  std::cout << (arguments.Has("json") ? description.json : description.text);
  return 0;
}

}  // namespace mmm_converter
