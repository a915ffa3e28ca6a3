// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "MMMConverterS2KF/terminal/manual.h"

namespace mmm_converter {

struct ManPageTitle {
  std::string name;                   ///< "MMMConverterS2KF-convert"
  std::string summary;                ///< one line
  std::vector<std::string> see_also;  ///< names of other pages of section 1
};

/// A page of section 1 for man: roff with the macros of man(7), in UTF-8.
std::string FormatManPage(const ManPageTitle& title, const Manual& manual);

}  // namespace mmm_converter
