// SPDX-License-Identifier: MIT
#pragma once

#include <set>
#include <string>

#include "common/pipeline/recording_labels.h"

namespace mmm_converter {

/// of_several: bodies, whose labels have their names in front: an MMM motion is of one.
/// @throws Error where the name of the output is none of a C3D, TRC or MMM file that can have them.
void CheckLabelledOutput(const std::string& file, bool of_several);

/// @throws Error where the output is the recording itself and would not keep all that is in it.
void CheckKeepsRecording(const std::string& file, const Recording& recording);

/// Names that no point of the recording can have in this output: other points, computed ones and
/// another subject's, have them and stay as they are.
std::set<std::string> NamesThatStay(const std::string& file, const Recording& recording);

/// Writes the recording under the names that were found. A C3D file as C3D keeps everything but
/// its points (WriteRelabelledC3d), an MMM 2.0 file as MMM everything but the motion's markers;
/// else there are the markers and unnamed points alone.
/// @throws Error; the file is then as it was before, or whole.
void WriteLabelled(const LabelReport& report);

}  // namespace mmm_converter
