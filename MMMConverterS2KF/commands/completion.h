// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "MMMConverterS2KF/commands/commands.h"

namespace mmm_converter {

/// A script for bash that completes the commands, their options and what these take. Names that
/// depend on the installation are asked of the program when they are needed (NamesOfKind).
std::string FormatBashCompletion(const std::vector<Command>& commands);

/// What NamesOfKind knows.
std::vector<std::string> KindsOfNames();

/// The commands, or what is installed of a kind, one of KindsOfNames: "configurations" and the
/// like.
std::vector<std::string> NamesOfKind(const std::string& kind);

}  // namespace mmm_converter
