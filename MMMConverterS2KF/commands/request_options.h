// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "MMMConverterS2KF/terminal/command_line.h"
#include "common/judge/verdict.h"
#include "common/pipeline/conversion_options.h"

namespace mmm_converter {

/// The rows of a table that a task has, as groups of options.
std::vector<OptionGroup> GroupsOf(const std::vector<Option>& table, Task task);

/// The options of exporters, and what is given of all.
OptionGroup ExportGroup(const std::string& title, const std::vector<Exporter>& exporters);
ExportFiles ExportsOf(const Arguments& arguments);

/// The groups of a command: its own, those of the tables between them and `last`, General at the
/// end; of the same title they are one. per_recording: may be given once for each positional
/// argument.
std::vector<OptionGroup> CommandOptions(Task task, std::vector<OptionGroup> own,
                                        const std::vector<OptionGroup>& last = {},
                                        const std::vector<std::string>& per_recording = {});

/// Reads what is given of the rows that the task has.
/// @throws UsageError where a value is none that is allowed.
void ReadArguments(const Arguments& arguments, const std::vector<Option>& table, Task task);

/// @throws UsageError as ReadArguments, and where options exclude or need each other.
ConversionRequest MakeRequest(Task task, const Arguments& arguments, const std::string& file);

/// Of a command that wrote what it was asked for: 3 where it is --strict and a verdict failed.
int ExitCodeOf(const Arguments& arguments, const std::vector<Verdict::Level>& verdicts);

/// What it says of each positional argument, with its own of the options per_recording.
std::vector<InputRequest> MakeInputs(Task task, const Arguments& arguments,
                                     const std::vector<std::string>& per_recording);

}  // namespace mmm_converter
