// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/support/error.h"

namespace mmm_converter {

/// What went wrong, and the option that helps, where there is one.
std::string WithAdvice(const Error& error);
std::string WithAdvice(const std::string& failure, Remedy remedy);

/// Likewise, and the attribute of a manifest that helps.
std::string WithManifestAdvice(const Error& error);

}  // namespace mmm_converter
