// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/motion/recording_content.h"
#include "common/motion/skeleton.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// A skeleton's motion as a recording: a label for each joint and end of a bone ("LeftFoot",
/// "LeftFoot.end"), and for bones of a body two points that turn with them ("LeftFoot.x",
/// "LeftFoot.y"). The unit is told by the length of the legs. Of a skeleton that is no body's there
/// are joints alone. Of several bodies, each below a root of its own, one is read.
/// @throws Error where there are several and options do not choose one, or one who is not there.
RecordingContent ContentOfSkeleton(SkeletonMotion motion, const std::string& format,
                                   const std::string& file, const ContentOptions& options,
                                   Warnings* warnings);

}  // namespace mmm_converter
