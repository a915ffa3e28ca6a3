// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "MMMConverterS2KF/batch/batch_run.h"
#include "MMMConverterS2KF/batch/entry_result.h"

namespace mmm_converter {

/// The whole manifest's results, as the journals of the output folder have them.
struct BatchResults {
  int converted = 0, failed = 0, missing = 0;
  int good = 0, to_check = 0, judged_failed = 0;  ///< of the converted, by verdict
  long frames = 0;
  double recorded_seconds = 0;  ///< length of all recordings
  double seconds = 0;           ///< spent on them, over all jobs
  double mean_distance_mm = 0;  ///< over the frames
};

/// Writes the pages that are asked for and not there yet, results.jsonl, results.csv and index.html
/// into the output folder.
/// @throws Error
BatchResults WriteBatchResults(const BatchManifest& manifest, const BatchOptions& options,
                               BatchProgress* progress);

/// An entry, what the journals have of it, and its files in the output folder (empty: not there).
struct ResultRow {
  const BatchEntry* entry = nullptr;
  std::optional<EntryResult> result;  ///< empty: was not converted yet
  std::string motion, report;
  std::string robot_motion = {};
};

/// What needs a look first: what was not converted, then by verdict, the worst first; else as they
/// are.
void SortByVerdict(std::vector<ResultRow>* rows);

/// A line of results.jsonl; README.md says what is in it.
Json ToJson(const ResultRow& row);

/// Over all rows.
BatchResults Summarize(const std::vector<ResultRow>& rows);

/// Lines as a table (CSV, RFC 4180) with a column for each figure and each name of metadata.
std::string FormatResultsCsv(const std::vector<Json>& lines);

}  // namespace mmm_converter
