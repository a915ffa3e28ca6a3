// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace mmm_converter {

/// What `--version` prints: the version, and the instruction set that this run computes with.
std::string VersionText();

}  // namespace mmm_converter
