// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace mmm_converter {

// Files that are compiled in; CMakeLists.txt says which.

std::string_view PageTemplate();  ///< with places {{name}}
std::string_view PageStyles();
std::string_view PageScript();
std::string_view PlotLibrary();
std::string_view SceneLibrary();
std::string_view LibraryLicences();

std::string_view IndexTemplate();  ///< of the index of a batch, with places {{name}}
std::string_view IndexStyles();
std::string_view IndexScript();

}  // namespace mmm_converter
