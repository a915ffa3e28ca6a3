// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/commands/comparison_output.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/report/comparison_json.h"
#include "MMMConverterS2KF/report/comparison_plot.h"
#include "MMMConverterS2KF/report/comparison_table.h"
#include "MMMConverterS2KF/terminal/progress.h"
#include "common/pipeline/comparison/comparison_setup.h"
#include "common/support/atomic_file.h"

namespace mmm_converter {

OptionGroup ComparisonOutputOptions() {
  return {"Output",
          {{"json", "FILE", "all figures as JSON", ""},
           {"csv", "FILE", "all figures as CSV", ""},
           {"gnuplot", "FILE", "a gnuplot script with its data, which draws SVG figures", ""},
           {"report", "FILE", "a page (HTML) with player and plots", ""}}};
}

void NameOutputs(const Arguments& arguments, OutputPlan* plan) {
  for (const OptionSpec& option : ComparisonOutputOptions().options) {
    plan->Write(arguments.Get(option.name).value_or(""));
  }
}

void WriteComparison(const Arguments& arguments, const std::string& title,
                     const Comparison& comparison) {
  FilesTogether files;
  if (const auto file = arguments.Get("json")) {
    WriteFileAtomically(*file, FormatJson(ToJson(comparison)));
  }
  if (const auto file = arguments.Get("csv")) {
    WriteFileAtomically(*file, FormatComparisonCsv(comparison));
  }
  if (const auto file = arguments.Get("gnuplot")) {
    const std::string stem = std::filesystem::path(*file).stem().string();
    WriteFileAtomically(*file, FormatComparisonPlot(comparison, stem));
  }
  if (const auto file = arguments.Get("report")) {
    WriteFileAtomically(*file, FormatReport(title, {{title, "", &comparison}}));
  }
  files.Commit();
}

std::string FormatPageOfRuns(const std::string& title, const std::string& text,
                             std::vector<Trial> trials, Contender contender) {
  std::vector<Contender> contenders = {std::move(contender)};
  MakeNamesUnique(&trials, &contenders);
  ProgressBar bar("runs");
  const Comparison comparison = Compare(std::move(trials), std::move(contenders), {},
                                        [&bar](int done, int all) { bar.Show(done, all); });
  return FormatReport(title, {{title, text, &comparison}});
}

}  // namespace mmm_converter
