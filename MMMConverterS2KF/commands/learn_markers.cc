// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/commands/commands.h"
#include "MMMConverterS2KF/commands/comparison_output.h"
#include "MMMConverterS2KF/commands/request_options.h"
#include "MMMConverterS2KF/report/learn_summary.h"
#include "MMMConverterS2KF/terminal/command_line.h"
#include "MMMConverterS2KF/terminal/log.h"
#include "MMMConverterS2KF/terminal/progress.h"
#include "common/pipeline/comparison/comparison_setup.h"
#include "common/pipeline/marker_learning.h"
#include "common/support/atomic_file.h"

namespace mmm_converter {
namespace {

const OptionGroup kLearnMarkersFiles = {
    "Files",
    {{"output,o", "FILE", "the marker set (.xml); needed", ""},
     {"name", "NAME", "of the marker set; default: the name of its file", ""},
     {"report", "FILE",
      "write a page (HTML): the recordings converted with the set, markers where they were learnt",
      ""},
     {"summary", "FILE", "write a summary as JSON", ""}}};

constexpr const char* kLearnMarkersUsage = R"(MMMConverterS2KF learn-markers RECORDING... [options]
Learns a laboratory's marker set from recordings whose labels are consistent: on which segment each
marker is worn, and where on it, by its name where that is a landmark's (LASI, R.Knee.Lateral) and
the body does not contradict it, else by how it moves. The result is a marker set for --marker-set
of convert, calibrate and batch, and for people to read and change. Markers of which this is not
sure and points that are computed from others are left out; the file says which and why. The more
the joints move in the recordings, the surer it is.

{}The options frames, subject, motion, unit, rate and up are given once for all recordings, or once
for each recording in the same order.

Examples
  MMMConverterS2KF learn-markers range_of_motion.c3d --height 1.75 -o our_set.xml
  MMMConverterS2KF learn-markers walk.c3d jump.c3d --height 1.75 -o our_set.xml --report set.html
  MMMConverterS2KF calibrate walk.c3d --height 1.75 --marker-set our_set.xml -o anna.xml
)";

// Given once for all recordings, or once for each in their order.
const std::vector<std::string> kLearnMarkersPerRecording = {"frames", "subject", "motion",
                                                            "unit",   "rate",    "up"};

LearnRequest MakeLearnRequest(const Arguments& arguments) {
  constexpr const char* kExample =
      "MMMConverterS2KF learn-markers walk.c3d --height 1.75 -o our_set.xml";
  if (arguments.positionals().empty()) {
    throw UsageError(fmt::format("learn-markers: which recordings? For instance: {}", kExample));
  }
  if (!arguments.Has("output")) {
    throw UsageError(
        fmt::format("learn-markers: where shall the marker set go? For instance: {}", kExample));
  }
  LearnRequest request;
  request.inputs = MakeInputs(task::kLearnMarkers, arguments, kLearnMarkersPerRecording);
  request.converter = MakeRequest(task::kLearnMarkers, arguments, "").converter;
  request.name = arguments.Get("name").value_or("");
  request.output = arguments.Get("output").value_or("");
  request.more_outputs = {arguments.Get("summary").value_or(""),
                          arguments.Get("report").value_or("")};
  return request;
}

// Each recording converted with the set, which is written.
std::string FormatLearnedReport(const LearnRequest& request, const LearnReport& learnt) {
  Contender contender = MakeContender(request.converter.config);
  std::vector<Trial> trials;
  Warnings told_when_learnt;
  for (InputRequest input : request.inputs) {
    input.marker_set = learnt.output;
    UseMarkerSet(input, &contender.config);
    trials.push_back(MakeTrial(std::move(input), "", contender.config, &told_when_learnt));
  }
  return FormatPageOfRuns("Marker set " + learnt.name, DescribeLearntSet(learnt), std::move(trials),
                          std::move(contender));
}

}  // namespace

Manual LearnMarkersManual() {
  return {kLearnMarkersUsage,
          CommandOptions(task::kLearnMarkers, {kLearnMarkersFiles}, {}, kLearnMarkersPerRecording),
          true};
}

int RunLearnMarkers(const Arguments& arguments) {
  StartLog(arguments.Get("log").value_or("info"));
  const LearnRequest request = MakeLearnRequest(arguments);
  ProgressBar bar("steps");
  const LearnReport report =
      RunLearning(request, [&bar](int done, int all) { bar.Show(done, all); });
  bar.Clear();
  LogWarnings(report.warnings);
  WriteFileAtomically(report.output, FormatLearnedSet(report));
  if (const auto file = arguments.Get("summary")) {
    WriteFileAtomically(*file, FormatJson(ToJson(report)));
  }
  if (const auto file = arguments.Get("report")) {
    WriteFileAtomically(*file, FormatLearnedReport(request, report));
  }
  std::cout << FormatLearnSummary(report);
  return 0;
}

}  // namespace mmm_converter
