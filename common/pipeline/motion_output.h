// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/io/mmm/mmm_motion.h"
#include "common/pipeline/conversion.h"

namespace mmm_converter {

/// Where the motion of a recording goes if nobody says: beside it.
std::string DefaultOutput(const std::string& file, bool is_osim);

/// Where the motion goes (as asked for, else the input's stem + "_mmm.xml" beside it, with a model
/// of OpenSim ".mot"), in which format, and what it is called (as asked for, else as in the
/// recording, else as the file; of several motions of a file each as it is).
/// @throws Error where that would overwrite a recording that is no MMM 2.0 file, or the format
/// can't
///         hold the motion.
void ChooseMotionOutput(const ConversionRequest& request, bool is_one_of_several,
                        ConversionPlan* plan);

/// Whether the output is of coordinates, in OpenSim's own format.
bool IsOsimMotion(const ConversionPlan& plan);

/// @throws Error where the output of the plan, in its format, can't hold a motion of its model.
void CheckHoldsMotion(const ConversionPlan& plan);

/// What a plan's motion is written with, but for its postures and markers.
MmmMotionOutput DescribeMotion(const ConversionRequest& request, const ConversionPlan& plan);

/// "MMM 2.0", "OpenSim": what the motion is written as.
std::string MotionFormat(const ConversionPlan& plan);

/// Where the deviations of coordinates go, beside a motion of OpenSim; empty: they are not written.
std::string DeviationsOutput(const ConversionPlan& plan);

/// Writes the results of one recording to their common output; several must be motions of an
/// MMM 2.0 file that are written as such. Of an MMM 2.0 recording, all other motions and sensors
/// are kept as they are. With a model of OpenSim and an output ".mot" or ".sto", its coordinates
/// are written, and their deviations, where they are known, beside them.
void WriteMotions(const ConversionRequest& request, const std::vector<ConversionReport*>& reports);

}  // namespace mmm_converter
