// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "MMMConverterS2KF/batch/manifest.h"
#include "MMMConverterS2KF/conversion/conversion.h"

namespace mmm_converter {

/// What the results say of a converted entry, a JSON object of figures; seconds: what it took.
std::string FormatResult(const ConversionReport& report, double seconds);

/// What they say of one that failed.
std::string FormatFailure(const std::string& reason, double seconds);

/// A line of the results: the entry, what the journal has of it (empty: nothing), and its files in
/// the output folder (empty: not there).
std::string FormatResultLine(const BatchEntry& entry, const std::string& result,
                             const std::string& motion, const std::string& report);

/// A few figures of a line, for summaries.
struct ResultFigures {
  std::string state;            ///< "converted", "failed", "missing"
  double mean_distance_mm = 0;  ///< of converted ones
  double seconds = 0;           ///< spent on it
  double recorded_seconds = 0;  ///< length of the recording
  long frames = 0;
  int warnings = 0;
};
ResultFigures ReadFigures(const std::string& line);

/// Result lines as a table (CSV, RFC 4180) with a column for each figure and each name of metadata.
std::string FormatResultsCsv(const std::vector<std::string>& lines);

}  // namespace mmm_converter
