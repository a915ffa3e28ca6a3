// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace mmm_converter::testing {

/// A page of five frames whose joints, contact bodies, file, motion, sources and warnings are all
/// kHostileText; the second of two flights has nothing but NaN.
std::string HostileDynamicsPage();

}  // namespace mmm_converter::testing
