// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <iostream>

#include "MMMConverterS2KF/batch/batch_file_kinds.h"
#include "MMMConverterS2KF/commands/commands.h"
#include "MMMConverterS2KF/commands/request_options.h"
#include "MMMConverterS2KF/live/live_file_kinds.h"
#include "MMMConverterS2KF/report/file_kinds.h"
#include "MMMConverterS2KF/report/version.h"
#include "MMMConverterS2KF/terminal/command_line.h"
#include "MMMConverterS2KF/terminal/log.h"

namespace mmm_converter {
namespace {

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
