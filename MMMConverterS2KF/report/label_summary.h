// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "MMMConverterS2KF/conversion/recording_labels.h"
#include "MMMConverterS2KF/report/json.h"

namespace mmm_converter {

/// The labels of a recording in a few lines, for people; of a repair also what was changed.
std::string FormatLabelSummary(const LabelReport& report, bool is_repair);

/// The same as JSON, with every change; README.md says what is in it.
Json ToJson(const LabelReport& report);

/// One line of what was changed: how many names were given, and to how many points.
std::string DescribeLabels(const FoundLabels& found);

/// The changes, as in the JSON of a LabelReport. first_frame: of the frames that were labelled.
Json ChangesJson(const FoundLabels& found, const MarkerSequence& markers);

}  // namespace mmm_converter
