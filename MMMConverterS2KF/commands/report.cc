// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <iostream>

#include "MMMConverterS2KF/commands/commands.h"
#include "MMMConverterS2KF/commands/comparison_output.h"
#include "MMMConverterS2KF/commands/request_options.h"
#include "MMMConverterS2KF/report/comparison_table.h"
#include "MMMConverterS2KF/terminal/command_line.h"
#include "MMMConverterS2KF/terminal/log.h"
#include "common/io/bytes/file_content.h"
#include "common/judge/evidence.h"
#include "common/pipeline/comparison/comparison_setup.h"
#include "common/pipeline/input/finished_motion.h"
#include "common/pipeline/input/input.h"
#include "common/support/atomic_file.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

const OptionGroup kOutput = {
    "Output",
    {{"output,o", "FILE", "the page; default: RECORDING without its ending + _report.html", ""},
     {"json", "FILE", "all figures as JSON", ""},
     {"csv", "FILE", "all figures as CSV", ""},
     {"gnuplot", "FILE", "a gnuplot script with its data, which draws SVG figures", ""}}};

constexpr const char* kReportUsage = R"(MMMConverterS2KF report RECORDING MOTION... [options]
Writes an HTML page that shows finished MMM motions together with the recording that they were
converted from: a player, marker distances and joint angles. It opens without a network. MOTION may
come from any program, and may be RECORDING itself if that is an MMM file with joint angles. Nothing
is converted. For a page with uncertainty and computing times use convert --report; to compare
several conversions use compare --report.

{}Examples
  MMMConverterS2KF report walk.c3d walk_mmm.xml
  MMMConverterS2KF report walk.xml walk.xml walk_mmm.xml -o walk.html
)";

// The motions as contenders, their results on the trial.
struct Solutions {
  std::vector<Contender> contenders;
  std::vector<Finished> results;
};

void AddSolution(const Trial& trial, const Finished& unsolved, const std::string& file,
                 MmmMotion motion, Solutions* solutions) {
  Contender contender;
  contender.name = std::filesystem::path(file).filename().string();
  contender.configuration = fmt::format("The motion \"{}\" of {}", motion.name, file);
  Finished finished = unsolved;
  finished.result.trajectory = AlignFrames(motion.trajectory, trial.markers, file);
  solutions->contenders.push_back(std::move(contender));
  solutions->results.push_back(std::move(finished));
}

Comparison CompareSolutions(const Arguments& arguments) {
  const std::vector<std::string>& files = arguments.positionals();
  InputRequest request = MakeRequest(task::kReport, arguments, files.front()).input;
  std::vector<MmmMotion> motions;
  for (std::size_t i = 1; i < files.size(); ++i) {
    motions.push_back(ReadPostures(files[i], request.reading.motion));
    if (!request.person.subject_file.empty()) continue;
    if (!request.person.size.height) request.person.size.height = motions.back().size.height;
    if (!request.person.size.mass) request.person.size.mass = motions.back().size.mass;
  }
  Warnings warnings;
  Trial trial = MakeTrial(request, "", ConverterConfig(), &warnings);
  if (!trial.failure.empty()) throw Error(trial.failure);
  LogWarnings(warnings);
  ConverterConfig config;
  UseMarkerSet(request, &config);
  Finished unsolved;
  unsolved.mapping =
      MatchMarkers(LabelsOf(trial.markers, request.file), trial.model, config, &unsolved.warnings)
          .mapping;
  Solutions solutions;
  for (std::size_t i = 1; i < files.size(); ++i) {
    AddSolution(trial, unsolved, files[i], std::move(motions[i - 1]), &solutions);
  }
  std::vector<Trial> trials = {std::move(trial)};
  MakeNamesUnique(&trials, &solutions.contenders);
  return CompareFinished(std::move(trials.front()), std::move(solutions.contenders),
                         std::move(solutions.results));
}

void TellStrangers(const Comparison& comparison) {
  for (const ComparisonRow& row : comparison.rows) {
    const double mean = row.quality.all.mean;
    if (!row.failure.empty() || !(mean > kMeanDistance.failed)) continue;
    LogWarning(fmt::format(
        "{}: is {:.0f} mm from the markers of {} on average: it seems to be another recording's "
        "motion, or of other frames",
        comparison.contenders[static_cast<std::size_t>(row.contender)].name, kMillimetres * mean,
        comparison.trials[static_cast<std::size_t>(row.trial)].name));
  }
}

std::string ReportOutputFile(const Arguments& arguments) {
  if (const auto file = arguments.Get("output")) return *file;
  const std::filesystem::path input = arguments.positionals().front();
  return (input.parent_path() / (input.stem().string() + "_report.html")).string();
}

}  // namespace

Manual ReportManual() { return {kReportUsage, CommandOptions(task::kReport, {kOutput}), true}; }

int RunReport(const Arguments& arguments) {
  if (arguments.positionals().size() < 2) {
    throw UsageError(
        "report: which recording and which motion? For instance: MMMConverterS2KF report walk.c3d "
        "walk_mmm.xml");
  }
  StartLog(arguments.Get("log").value_or("info"));
  const std::string output = ReportOutputFile(arguments);
  OutputPlan plan;
  NameInputs(MakeRequest(task::kReport, arguments, "").input, &plan);
  for (const std::string& file : arguments.positionals()) plan.Read(file);
  NameOutputs(arguments, &plan);
  plan.Write(output);
  plan.Check();
  const Comparison comparison = CompareSolutions(arguments);
  TellStrangers(comparison);
  plan.Check();
  const std::string title = comparison.trials.front().name;
  FilesTogether files;
  WriteComparison(arguments, title, comparison);
  WriteFileAtomically(output, FormatReport(title, {{title, "", &comparison}}));
  files.Commit();
  std::cout << FormatComparisonTable(comparison) << output << '\n';
  return 0;
}

}  // namespace mmm_converter
