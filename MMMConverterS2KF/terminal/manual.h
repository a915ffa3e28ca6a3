// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "MMMConverterS2KF/terminal/command_line.h"

namespace mmm_converter {

/// In a Manual's text, where its options are described.
inline constexpr const char* kPlaceOfOptions = "{}";

/// How a command is used. Its command line is read by this; help, manual page and completion are
/// made of it.
struct Manual {
  /// First line: the synopsis. Lines without indentation are paragraphs; indented ones are examples
  /// or, where two spaces follow the first word or words, a list of terms; a single line before
  /// these is their title. kPlaceOfOptions stands in it once, or not at all.
  std::string text;
  std::vector<OptionGroup> options;
  bool several_inputs = false;  ///< more than one positional argument
};

std::string FormatHelp(const Manual& manual);

/// The names by which it is given, the long one first: "--output", "-o".
std::vector<std::string> NamesOf(const OptionSpec& option);

}  // namespace mmm_converter
