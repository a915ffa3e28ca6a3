// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <iostream>
#include <nlohmann/json.hpp>
#include <utility>

#include "MMMConverterS2KF/commands/commands.h"
#include "MMMConverterS2KF/commands/request_options.h"
#include "MMMConverterS2KF/report/label_page.h"
#include "MMMConverterS2KF/report/label_summary.h"
#include "MMMConverterS2KF/terminal/command_line.h"
#include "MMMConverterS2KF/terminal/log.h"
#include "MMMConverterS2KF/terminal/progress.h"
#include "common/pipeline/labelled_output.h"
#include "common/pipeline/recording_labels.h"
#include "common/support/atomic_file.h"

namespace mmm_converter {
namespace {

const OptionGroup kLabelFiles = {
    "Files",
    {{"output,o", "FILE",
      "the labelled recording: C3D, TRC or MMM (.xml); may be RECORDING. Default: nothing is "
      "written, the summary says what would be",
      ""},
     {"report", "FILE", "write a page (HTML): what was changed, and tracks before and after", ""},
     {"summary", "FILE", "write a summary as JSON", ""}}};

constexpr const char* kLabelUsage = R"(MMMConverterS2KF label RECORDING [options]
Gives the points of a recording the names of the markers that they are, by the body that wears them:
of points without labels, of trajectories that break and go on under another number and, with
--repair, of labels that are wrong. A point that is none of the markers, or not surely one, stays
without a name; no measured point is lost. A C3D file keeps its parameters, analog samples and
events byte for byte.

The names are, of a repair and of a recording whose labels are all known, the recording's own, which
are changed where they are wrong; else those of the markers that a --subject-file
knows or that the recording --like has; else, with --height alone, all of the --marker-set, which by
default is KIT's. A calibrated person is labelled most surely. The verdict (good, check or failed)
says whether the names can be trusted: whether all were found, and whether the points that have them
are where this person wears markers.

Several persons and rigid objects may be in one cloud of points: each point belongs to one of them
or to nobody. Labels then begin with the name of the person or of the object's model, and convert
--subject NAME takes one of them. Persons need a frame in which they stand apart.

{}Examples
  MMMConverterS2KF label walk.c3d --subject-file anna.xml -o walk_labelled.c3d
  MMMConverterS2KF label walk.c3d --like standing.c3d --height 1.68 -o walk_labelled.c3d
  MMMConverterS2KF label walk.c3d --height 1.68 --marker-set kit53 -o walk.trc
  MMMConverterS2KF label both.c3d --subject-file anna.xml --and-subject-file ben.xml -o named.c3d
  MMMConverterS2KF label cup.c3d --subject-file anna.xml --object-models objects -o named.c3d
  MMMConverterS2KF label walk.c3d --repair --height 1.68 --report walk_labels.html
  MMMConverterS2KF label walk.c3d --repair --subject-file anna.xml -o walk_repaired.c3d
)";

LabelRequest MakeLabelRequest(const Arguments& arguments) {
  if (!arguments.positional()) {
    throw UsageError(
        "label: which recording? For instance: MMMConverterS2KF label walk.c3d --height 1.75 -o "
        "labelled.c3d");
  }
  ConversionRequest asked = MakeRequest(task::kLabel, arguments, *arguments.positional());
  LabelRequest request;
  request.input = std::move(asked.input);
  request.converter = std::move(asked.converter);
  request.hints = std::move(asked.label_hints);
  request.output = arguments.Get("output").value_or("");
  request.more_outputs = {arguments.Get("summary").value_or(""),
                          arguments.Get("report").value_or("")};
  return request;
}

}  // namespace

Manual LabelManual() { return {kLabelUsage, CommandOptions(task::kLabel, {kLabelFiles})}; }

int RunLabel(const Arguments& arguments) {
  StartLog(arguments.Get("log").value_or("info"));
  const LabelRequest request = MakeLabelRequest(arguments);
  ProgressBar bar("frames");
  const LabelReport report = RunLabelling(request, [&](int done, int all) {
    bar.Show(done, all);
    return true;
  });
  bar.Clear();
  FilesTogether files;
  if (!report.output.empty()) WriteLabelled(report);
  LogWarnings(report.warnings);
  if (const auto file = arguments.Get("summary")) {
    WriteFileAtomically(*file, FormatJson(ToJson(report)));
  }
  if (const auto file = arguments.Get("report")) {
    WriteFileAtomically(*file, FormatLabelPage(report));
  }
  files.Commit();
  std::cout << FormatLabelSummary(report);
  return ExitCodeOf(arguments, {report.verdict.level});
}

}  // namespace mmm_converter
