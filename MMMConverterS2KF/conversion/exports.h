// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace mmm_converter {

struct ConversionReport;

/// Files of a conversion for other programs. Empty: not asked for.
struct ExportFiles {
  std::string csv;  ///< postures, and their standard deviations and derivatives
  std::string trc;  ///< markers, measured and of the model
  std::string mot;  ///< postures, for OpenSim
};

/// @throws Error; each file is then as it was before, or whole.
void WriteExports(const ExportFiles& files, const ConversionReport& report);

}  // namespace mmm_converter
