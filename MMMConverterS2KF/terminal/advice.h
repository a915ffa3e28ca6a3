// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/support/advice.h"

namespace mmm_converter {

/// Messages name the options of the command line.
Wording CommandLineWording();

/// What went wrong, and the attribute of a manifest that helps, where there is one.
std::string WithManifestAdvice(const Error& error);

}  // namespace mmm_converter
