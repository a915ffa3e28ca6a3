// SPDX-License-Identifier: MIT
#include "common/support/error.h"

namespace mmm_converter {

Error::Error(const std::string& message) : std::runtime_error(message) {}
Error::~Error() = default;

}  // namespace mmm_converter
