// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/report.h"

namespace mmm_converter {

std::string FormatReport(const std::string& /*title*/,
                         const std::vector<ReportSection>& /*sections*/) {
  return "<!DOCTYPE html>\n";
}

}  // namespace mmm_converter
