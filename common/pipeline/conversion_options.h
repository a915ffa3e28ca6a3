// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/pipeline/conversion.h"
#include "common/pipeline/option.h"
#include "common/support/advice.h"

namespace mmm_converter {

/// All that can be asked of a recording, its person and its conversion, by whichever medium and for
/// whichever task; every row goes to a member of the request. To add one: its member, its row, and
/// what is done with it.
std::vector<Option> Options(ConversionRequest* request);

/// The same as they are described, without a request.
const std::vector<Option>& DescribedOptions();

/// What an option is, for people who use this medium for this task.
std::string HelpOf(Medium medium, const Option& option, Task task);

/// What is wrong where options of a request exclude or need each other; else nothing.
std::string Contradiction(const ConversionRequest& request);

/// An option with a value that a Remedy asks for, as in `height=1.75`; empty: there is none.
std::string ExampleOf(Medium medium, Remedy remedy);

/// How messages name options and give advice: by the table.
Wording WordingOf(Medium medium);

}  // namespace mmm_converter
