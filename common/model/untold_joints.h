// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "common/model/kinematic_model.h"

namespace mmm_converter {

/// Joints of the reference model's feet that these markers move but do not tell from others of the
/// foot, as indices of the model:
///
///   inversion (LAy, RAy)          told by markers that are apart across the foot, by an eighth of
///                                 the shank's length or more; heel and toe lie along it
///   metatarsals (LMrot, RMrot)    told by such markers in front of the joint, with two behind it
///
/// Where such a joint is free, it takes up what skin moves, and dorsiflexion loses it. Of models
/// without these joints: none.
std::vector<int> UntoldJoints(const KinematicModel& model, const std::vector<MarkerIx>& markers);

}  // namespace mmm_converter
