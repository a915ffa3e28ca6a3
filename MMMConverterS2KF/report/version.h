// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace mmm_converter {

/// What `--version` prints: the version, the instruction set that this run computes with,
/// what was built and with which versions of other libraries.
std::string VersionText();

}  // namespace mmm_converter
