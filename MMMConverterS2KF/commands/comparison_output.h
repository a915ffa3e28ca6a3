// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "MMMConverterS2KF/report/report.h"
#include "MMMConverterS2KF/terminal/command_line.h"
#include "common/pipeline/comparison/comparison.h"
#include "common/support/output_plan.h"

namespace mmm_converter {

/// The options for what a comparison is written to: --json, --csv, --gnuplot and --report.
OptionGroup ComparisonOutputOptions();

/// Says in the plan which files WriteComparison will write.
void NameOutputs(const Arguments& arguments, OutputPlan* plan);

/// Writes the files asked for; options that a command does not have are not.
/// @throws Error
void WriteComparison(const Arguments& arguments, const std::string& title,
                     const Comparison& comparison);

/// A page with recordings as one contender converts them, which happens here, with progress. text:
/// what stands above them.
std::string FormatPageOfRuns(const std::string& title, const std::string& text,
                             std::vector<Trial> trials, Contender contender);

}  // namespace mmm_converter
