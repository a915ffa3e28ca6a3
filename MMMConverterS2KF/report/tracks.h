// SPDX-License-Identifier: MIT
#pragma once

#include "MMMConverterS2KF/report/json.h"
#include "common/pipeline/comparison/comparison.h"

namespace mmm_converter {

/// What the page draws of a comparison: models, measured markers, postures, distances.
/// Arrays are PackedArrays, in SI units, of the DrawnFrames; frames run fastest unless said
/// otherwise.
Json TracksJson(const Comparison& comparison);

/// Postures of a model over time, of the DrawnFrames: what data.js calls a Motion.
Json MotionJson(const KinematicModel& model, const PoseTrajectory& trajectory);

}  // namespace mmm_converter
