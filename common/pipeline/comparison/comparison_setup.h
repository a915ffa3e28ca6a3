// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/pipeline/comparison/comparison.h"
#include "common/pipeline/input/converter_choice.h"
#include "common/pipeline/input/input.h"
#include "common/pipeline/option.h"
#include "common/support/warnings.h"

namespace mmm_converter {

// What can't be read becomes a trial or contender with its failure: the others still run.

/// config: an empty one (the shipped one of the S2KFConverter), a file, or the name of a shipped
/// one.
Contender MakeContender(const std::string& config);

/// Says in the plan which files a contender is from.
void NameInputs(const Contender& contender, OutputPlan* plan);

/// A recording; its person's height is estimated with the markers and joints of `config` where
/// nothing tells it. truth_file: MMM motion that the markers were made from; may be empty.
Trial MakeTrial(InputRequest request, const std::string& truth_file, const ConverterConfig& config,
                Warnings* warnings);

/// The table of what is asked of a comparison.
std::vector<Option> Options(ComparisonOptions* options);

/// Names that are there several times get a number.
void MakeNamesUnique(std::vector<Trial>* trials, std::vector<Contender>* contenders);

}  // namespace mmm_converter
