// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "MMMConverterS2KF/report/json.h"
#include "common/pipeline/recording_labels.h"

namespace mmm_converter {

/// The labels of a recording in a few lines, for people; of a repair also what was changed.
std::string FormatLabelSummary(const LabelReport& report);

/// The same as JSON, with every change; README.md says what is in it.
Json ToJson(const LabelReport& report);

/// One line of what was changed: how many names were given, and to how many points.
std::string DescribeLabels(const FoundLabels& found);

/// Names, unnamed and changes, as in the JSON of a LabelReport. markers: what was labelled, of
/// which frame 0 is the file's first_frame.
Json LabelsJson(const FoundLabels& found, const MarkerSequence& markers, int first_frame);

}  // namespace mmm_converter
