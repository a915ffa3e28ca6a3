// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace mmm_converter {

enum class NamedSide { kNone, kLeft, kRight };

/// The side that each of some labels names, where the set has the same label of the other side too:
/// L and R, or left and right, at the beginning or the end, in any spelling (LASI, L.Shoulder,
/// Left_Knee, HeelR). Otherwise none: L3 is a vertebra.
std::vector<NamedSide> NamedSides(const std::vector<std::string>& labels);

}  // namespace mmm_converter
