// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <limits>

#include "MMMConverterS2KF/commands/commands.h"
#include "MMMConverterS2KF/commands/comparison_output.h"
#include "MMMConverterS2KF/report/comparison_table.h"
#include "MMMConverterS2KF/terminal/command_line.h"
#include "MMMConverterS2KF/terminal/input_options.h"
#include "MMMConverterS2KF/terminal/log.h"
#include "MMMConverterS2KF/terminal/progress.h"
#include "common/pipeline/comparison/comparison_setup.h"
#include "common/pipeline/input/input.h"

namespace mmm_converter {
namespace {

const OptionGroup kContest = {
    "Comparison",
    {{"config,c", "FILE",
      "a configuration, or the name of a shipped one; several times; default: s2kf_default, "
      "jacobian_gradient, jacobian_least_squares and jacobian_pull",
      "", true},
     {"truth", "FILE", "MMM motion that the markers were made from; -: not known", "", true},
     {"hide", "P", "hide markers from the converters; errors are still taken over all markers", ""},
     {"hide-model", "paper|stationary",
      "paper (default): P is the probability with which a visible marker hides in a frame, for "
      "Poisson(100) frames; the paper has 0.005. stationary: a share P is hidden throughout",
      ""},
     {"repeat", "N", "runs, each with other hidden markers; default: 1", ""},
     {"seed", "N", "of the first run; the next runs have the next seeds; default: 1", ""},
     {"jobs", "N",
      "runs at a time; default: all cores. Only times depend on it: 1 leaves them undisturbed",
      ""}}};

const OptionGroup kGeneral = {"General",
                              {{"log", "LEVEL", "off, error, warning, info or debug", ""},
                               {"help,h", "", "print this help", ""}}};

constexpr const char* kUsage = R"(MMMConverterS2KF compare RECORDING... [options]
Converts every recording with every configuration and compares the results. The table is printed;
files are only written where an option below asks for them.

Distances are between measured and model markers, hidden ones included, over the markers and joints
that all configurations use. The optimum is the least-squares posture of each frame on its own. A
frame is good up to 1.2 optimum + 2 mm, lost beyond 2 optimum + 20 mm.

{}The options truth, subject, motion, height, mass, person, subject-file and up are given once for
all recordings, or once for each recording in the same order. The exit code is 1 if a conversion
failed; the others are compared nevertheless.

Examples
  MMMConverterS2KF compare walk.c3d run.c3d --height 1.75 --report comparison.html
  MMMConverterS2KF compare walk.c3d -c s2kf_default -c my.xml --json figures.json
  MMMConverterS2KF compare walk.c3d --hide 0.005 --repeat 100 --csv figures.csv
  MMMConverterS2KF compare handstand.c3d --truth handstand_true.xml
)";

// Given once for all recordings, or once for each in their order.
const std::vector<std::string> kPerRecording = {"truth", "subject", "motion",       "height",
                                                "mass",  "person",  "subject-file", "up"};

std::vector<OptionGroup> Options() {
  std::vector<OptionGroup> options = {kContest, ComparisonOutputOptions()};
  options.insert(options.end(), InputOptions().begin(), InputOptions().end());
  options.push_back(kGeneral);
  for (OptionGroup& group : options) {
    for (OptionSpec& option : group.options) {
      option.repeatable |= std::count(kPerRecording.begin(), kPerRecording.end(), option.name) > 0;
    }
  }
  return options;
}

ComparisonOptions MakeOptions(const Arguments& arguments) {
  constexpr int kMost = std::numeric_limits<int>::max();
  ComparisonOptions options;
  const std::string model = arguments.GetChoice("hide-model", {"paper", "stationary"}, "paper");
  options.hiding.model = model == "paper" ? HidingModel::kPaper : HidingModel::kStationary;
  options.hiding.amount = arguments.GetNumber("hide", "a number from 0 to 1").value_or(0);
  if (options.hiding.amount < 0 || options.hiding.amount > 1) {
    throw UsageError(fmt::format("--hide: {:g} is not allowed; give a number from 0 to 1",
                                 options.hiding.amount));
  }
  options.runs = arguments.GetInteger("repeat", 1, 100000).value_or(1);
  options.seed = static_cast<std::uint64_t>(arguments.GetInteger("seed", 0, kMost).value_or(1));
  options.jobs = arguments.GetInteger("jobs", 1, 1024).value_or(0);
  return options;
}

std::vector<Contender> MakeContenders(const Arguments& arguments) {
  std::vector<std::string> configs = arguments.GetAll("config");
  if (configs.empty()) {
    configs = {"s2kf_default", "jacobian_gradient", "jacobian_least_squares", "jacobian_pull"};
  }
  std::vector<Contender> contenders;
  contenders.reserve(configs.size());
  for (const std::string& config : configs) contenders.push_back(MakeContender(config));
  return contenders;
}

void CheckOutputs(const Arguments& arguments, const std::vector<Contender>& contenders) {
  OutputPlan plan;
  for (const Contender& contender : contenders) NameInputs(contender, &plan);
  const std::vector<std::string>& files = arguments.positionals();
  for (std::size_t i = 0; i < files.size(); ++i) {
    const Arguments own = arguments.ForPositional(static_cast<int>(i), kPerRecording);
    NameInputs(MakeInputRequest(own, files[i]), &plan);
    plan.Read(own.Get("truth").value_or(""));
  }
  NameOutputs(arguments, &plan);
  plan.Check();
}

std::vector<Trial> MakeTrials(const Arguments& arguments, const ConverterConfig& config) {
  std::vector<Trial> trials;
  Warnings warnings;
  const std::vector<std::string>& files = arguments.positionals();
  for (std::size_t i = 0; i < files.size(); ++i) {
    const Arguments own = arguments.ForPositional(static_cast<int>(i), kPerRecording);
    const std::string truth = own.Get("truth").value_or("-");
    trials.push_back(
        MakeTrial(MakeInputRequest(own, files[i]), truth == "-" ? "" : truth, config, &warnings));
  }
  LogWarnings(warnings);
  return trials;
}

}  // namespace

Manual CompareManual() { return {kUsage, Options(), true}; }

int RunCompare(const Arguments& arguments) {
  if (arguments.positionals().empty()) {
    throw UsageError(
        "compare: which recordings? For instance: MMMConverterS2KF compare walk.c3d --height 1.75");
  }
  StartLog(arguments.Get("log").value_or("info"));
  const ComparisonOptions options = MakeOptions(arguments);
  std::vector<Contender> contenders = MakeContenders(arguments);
  const InputRequest request = MakeInputRequest(arguments.ForPositional(0, kPerRecording), "");
  for (Contender& contender : contenders) UseMarkerSet(request, &contender.config);
  CheckOutputs(arguments, contenders);
  std::vector<Trial> trials = MakeTrials(arguments, contenders.front().config);
  MakeNamesUnique(&trials, &contenders);
  ProgressBar bar("runs");
  const Comparison comparison = Compare(std::move(trials), std::move(contenders), options,
                                        [&](int done, int all) { bar.Show(done, all); });
  bar.Clear();
  WriteComparison(arguments, "Comparison", comparison);
  std::cout << FormatComparisonTable(comparison);
  return comparison.num_failures() > 0 ? 1 : 0;
}

}  // namespace mmm_converter
