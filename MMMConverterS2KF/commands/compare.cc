// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <limits>

#include "MMMConverterS2KF/commands/commands.h"
#include "MMMConverterS2KF/commands/comparison_output.h"
#include "MMMConverterS2KF/commands/request_options.h"
#include "MMMConverterS2KF/report/comparison_table.h"
#include "MMMConverterS2KF/terminal/command_line.h"
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
     {"truth", "FILE", "MMM motion that the markers were made from; -: not known", "", true}}};

constexpr const char* kCompareUsage = R"(MMMConverterS2KF compare RECORDING... [options]
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
const std::vector<std::string> kComparePerRecording = {"truth", "subject", "motion",       "height",
                                                       "mass",  "person",  "subject-file", "up"};

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

void CheckOutputs(const Arguments& arguments, const std::vector<InputRequest>& inputs,
                  const std::vector<Contender>& contenders) {
  OutputPlan plan;
  for (const Contender& contender : contenders) NameInputs(contender, &plan);
  for (const InputRequest& input : inputs) NameInputs(input, &plan);
  for (const std::string& truth : arguments.GetAll("truth")) plan.Read(truth);
  NameOutputs(arguments, &plan);
  plan.Check();
}

std::vector<Trial> MakeTrials(const Arguments& arguments, const std::vector<InputRequest>& inputs,
                              const ConverterConfig& config) {
  std::vector<Trial> trials;
  Warnings warnings;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const Arguments own = arguments.ForPositional(static_cast<int>(i), kComparePerRecording);
    const std::string truth = own.Get("truth").value_or("-");
    trials.push_back(MakeTrial(inputs[i], truth == "-" ? "" : truth, config, &warnings));
  }
  LogWarnings(warnings);
  return trials;
}

}  // namespace

Manual CompareManual() {
  ComparisonOptions options;
  std::vector<OptionGroup> last = GroupsOf(Options(&options), task::kCompare);
  last.push_back(ComparisonOutputOptions());
  return {kCompareUsage, CommandOptions(task::kCompare, {kContest}, last, kComparePerRecording),
          true};
}

int RunCompare(const Arguments& arguments) {
  if (arguments.positionals().empty()) {
    throw UsageError(
        "compare: which recordings? For instance: MMMConverterS2KF compare walk.c3d --height 1.75");
  }
  StartLog(arguments.Get("log").value_or("info"));
  ComparisonOptions options;
  ReadArguments(arguments, Options(&options), task::kCompare);
  std::vector<Contender> contenders = MakeContenders(arguments);
  const std::vector<InputRequest> inputs =
      MakeInputs(task::kCompare, arguments, kComparePerRecording);
  for (Contender& contender : contenders) UseMarkerSet(inputs.front(), &contender.config);
  CheckOutputs(arguments, inputs, contenders);
  std::vector<Trial> trials = MakeTrials(arguments, inputs, contenders.front().config);
  CheckOutputs(arguments, inputs, contenders);
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
