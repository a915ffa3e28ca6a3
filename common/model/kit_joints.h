// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace mmm_converter {

/// The 44 joints of KIT's motions since 2016, in their order. Those before had 40: without LFx,
/// LMrot, RFx and RMrot (the feet).
const std::vector<std::string>& KitJointNames();

}  // namespace mmm_converter
