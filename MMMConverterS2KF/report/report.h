// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "MMMConverterS2KF/report/json.h"
#include "common/pipeline/comparison/comparison.h"

namespace mmm_converter {

/// A part of a report: what was compared, and what is said of it.
struct ReportSection {
  std::string title;
  std::string text;  ///< paragraphs, separated by empty lines; may be empty
  const Comparison* comparison = nullptr;
  const Json* ground = nullptr;  ///< GroundJson of its one trial; null, or of null: not drawn
  std::string verdict = {};      ///< of a conversion, in a word; empty: there is none
};

/// One self-contained HTML page: tables, a player, plots. A single conversion is a comparison of
/// one contender on one trial. patient: PatientJson, whose page begins with the person and ends
/// with the tracking's figures; null, or of null: a page of recordings.
std::string FormatReport(const std::string& title, const std::vector<ReportSection>& sections,
                         const Json* patient = nullptr);

}  // namespace mmm_converter
