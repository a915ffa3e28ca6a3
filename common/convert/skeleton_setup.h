// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "common/convert/marker_set.h"
#include "common/io/recording/recording.h"
#include "common/model/kinematic_model.h"
#include "common/model/subject.h"

namespace mmm_converter {

/// Whether a model has the segments that joints of a body are put on.
bool HasBody(const KinematicModel& reference);

/// The person of a skeleton, by its own lengths: scales of limbs, hips, shoulders and trunk
/// relative to the height, which they tell where none is given. recording: with a body; reference:
/// of 1 m, HasBody.
Subject SubjectOfSkeleton(const Recording& recording, const KinematicModel& reference,
                          const std::optional<double>& height);

/// Where joints of a skeleton, and the points that turn with its bones, are on the model. Centres
/// of shoulders, elbows, wrists, hips, knees and ankles are those of the model. Where all others
/// are, the postures tell that these have in some frames: so the orientations of bones count
/// whatever pose of the skeleton is its zero. Points that do not turn with their segment are left
/// out. joints: tracked ones.
MarkerSet PlaceSkeleton(const Recording& recording, const KinematicModel& reference,
                        const std::vector<int>& joints);

}  // namespace mmm_converter
