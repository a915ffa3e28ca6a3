// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "MMMConverterS2KF/report/json.h"
#include "common/pipeline/marker_learning.h"

namespace mmm_converter {

/// What was learnt in a few lines, for people: the markers of each segment, and what was left out.
std::string FormatLearnSummary(const LearnReport& report);

/// The same in two paragraphs for a page, on which the recordings are converted with the set.
std::string DescribeLearntSet(const LearnReport& report);

/// What was learnt as JSON, with every place; README.md says what is in it.
Json ToJson(const LearnReport& report);

}  // namespace mmm_converter
