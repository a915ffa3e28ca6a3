// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/model/kinematic_model.h"

namespace mmm_converter {

/// The 44 joints of KIT's motions since 2016, in their order. Those before had 40: without LFx,
/// LMrot, RFx and RMrot (the feet).
const std::vector<std::string>& KitJointNames();

/// "head", "spine", "left arm", "right arm", "left leg" or "right leg": what a joint of the MMM
/// model moves; empty: it is no joint of that model.
std::string LimbOfJoint(std::string_view joint);

/// The name of a segment, joint or marker with its side exchanged: "L..." and "R...", or "Left..."
/// and "Right..."; empty where it has none.
std::string MirroredName(const std::string& name);

/// "femur_l" for "femur_r", "l_hand" for "r_hand", and as MirroredName; empty: has no side.
std::string MirroredOsimName(const std::string& name);

/// Of each of these markers, which of them has its name with the side exchanged; -1: none.
std::vector<int> MirroredMarkers(const KinematicModel& model, const std::vector<MarkerIx>& markers);

}  // namespace mmm_converter
