// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/support/error.h"

namespace mmm_converter::python {

/// The message, with the keyword of the package's functions that gives what is missing.
std::string WithKeyword(const Error& error);

}  // namespace mmm_converter::python
