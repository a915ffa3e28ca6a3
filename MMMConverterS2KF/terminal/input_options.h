// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "MMMConverterS2KF/terminal/command_line.h"
#include "common/pipeline/input/input.h"

namespace mmm_converter {

/// The options of an InputRequest, for every command that reads recordings.
const std::vector<OptionGroup>& InputOptions();

/// "A:B": frames A to B-1, counted from 0; either may be left out.
/// @throws UsageError
void ParseFrames(const std::string& text, InputRequest* request);

/// @throws UsageError
InputRequest MakeInputRequest(const Arguments& arguments, const std::string& file);

}  // namespace mmm_converter
