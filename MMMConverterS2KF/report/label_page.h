// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/pipeline/recording_labels.h"

namespace mmm_converter {

/// One self-contained HTML page about the labels of a recording: what was changed, and where the
/// points under each name are, before and after.
std::string FormatLabelPage(const LabelReport& report);

}  // namespace mmm_converter
