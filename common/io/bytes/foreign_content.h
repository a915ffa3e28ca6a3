// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace mmm_converter {

/// What the first bytes of a file are, if that is nothing that is read here, and what to do: "is
/// packed (gzip); unpack it first". Empty: nothing that is known.
std::string NameForeignContent(std::string_view start);

}  // namespace mmm_converter
