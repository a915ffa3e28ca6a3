// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/commands/commands.h"
#include "MMMConverterS2KF/commands/request_options.h"
#include "MMMConverterS2KF/report/comparison_json.h"
#include "MMMConverterS2KF/report/comparison_plot.h"
#include "MMMConverterS2KF/report/comparison_table.h"
#include "MMMConverterS2KF/report/report.h"
#include "MMMConverterS2KF/terminal/command_line.h"
#include "MMMConverterS2KF/terminal/log.h"
#include "MMMConverterS2KF/terminal/progress.h"
#include "common/pipeline/comparison/comparison_setup.h"
#include "common/pipeline/comparison/evaluation.h"
#include "common/pipeline/input/input.h"
#include "common/support/atomic_file.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

const OptionGroup kEvaluation = {
    "Evaluation",
    {{"output,o", "FOLDER", "where the report goes; default: evaluation", ""},
     {"repeat", "N", "runs of the occlusion experiment; default: 100, as in the paper", ""},
     {"jobs", "N", "runs at a time; default: all cores", ""}}};

constexpr const char* kEvaluateUsage = R"(MMMConverterS2KF evaluate [RECORDING...] [options]
Repeats the evaluation of the paper: a synthetic handstand, with all markers and with markers hidden
at random, is tracked by the S2KF in the paper's and in the default configuration, by the UKF and
EKF, and by framewise fits. RECORDINGs are compared in addition. This takes one to two minutes on
two cores. Writes report.html, evaluation.json and a gnuplot script for each experiment into FOLDER.

{}Examples
  MMMConverterS2KF evaluate
  MMMConverterS2KF evaluate walk.c3d -o results --height 1.75
)";

std::vector<Trial> ReadOthers(const Arguments& arguments) {
  std::vector<Trial> trials;
  Warnings warnings;
  for (const InputRequest& input : MakeInputs(task::kEvaluate, arguments, {})) {
    trials.push_back(MakeTrial(input, "", ConverterConfig(), &warnings));
  }
  LogWarnings(warnings);
  return trials;
}

std::string ScriptFile(const std::string& folder, const std::string& experiment) {
  return fmt::format("{}/{}.gp", folder, experiment);
}

std::string FiguresFile(const std::string& folder) { return folder + "/evaluation.json"; }
std::string PageFile(const std::string& folder) { return folder + "/report.html"; }

void CheckOutputs(const Arguments& arguments, const std::string& folder) {
  OutputPlan plan;
  NameInputs(MakeRequest(task::kEvaluate, arguments, "").input, &plan);
  for (const std::string& file : arguments.positionals()) plan.Read(file);
  for (const std::string& name : ExperimentNames()) plan.WriteIntoFolder(ScriptFile(folder, name));
  plan.WriteIntoFolder(FiguresFile(folder));
  plan.WriteIntoFolder(PageFile(folder));
  plan.Check();
}

void WriteFiles(const std::string& folder, const std::vector<Experiment>& experiments) {
  FilesTogether files;
  std::vector<ReportSection> sections;
  Json json = Json::object();
  for (const Experiment& experiment : experiments) {
    const Comparison& comparison = experiment.comparison;
    sections.push_back({experiment.title, experiment.text, &comparison});
    json[experiment.name] = ToJson(comparison);
    WriteFileAtomically(ScriptFile(folder, experiment.name),
                        FormatComparisonPlot(comparison, experiment.name));
  }
  WriteFileAtomically(FiguresFile(folder), FormatJson(json));
  WriteFileAtomically(PageFile(folder), FormatReport("Evaluation", sections));
  files.Commit();
}

}  // namespace

Manual EvaluateManual() {
  return {kEvaluateUsage, CommandOptions(task::kEvaluate, {kEvaluation}), true};
}

int RunEvaluate(const Arguments& arguments) {
  StartLog(arguments.Get("log").value_or("info"));
  const std::string folder = arguments.Get("output").value_or("evaluation");
  CheckOutputs(arguments, folder);
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) throw Error(fmt::format("{}: {}", folder, failure.message()));

  EvaluationRequest request;
  request.runs = arguments.GetInteger("repeat", 1, 100000).value_or(request.runs);
  request.jobs = arguments.GetInteger("jobs", 1, 1024).value_or(0);
  request.others = ReadOthers(arguments);
  CheckOutputs(arguments, folder);
  ProgressBar bar("runs");
  const std::vector<Experiment> experiments = Evaluate(
      request, [&](const std::string& stage, int done, int all) { bar.Show(done, all, stage); });
  bar.Clear();
  WriteFiles(folder, experiments);
  int failures = 0;
  for (const Experiment& experiment : experiments) {
    std::cout << experiment.title << "\n\n" << FormatComparisonTable(experiment.comparison) << '\n';
    failures += experiment.comparison.num_failures();
  }
  std::cout << FormatPaperTable(experiments) << '\n' << folder << "/report.html\n";
  return failures > 0 ? 1 : 0;
}

}  // namespace mmm_converter
