// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "MMMConverterS2KF/batch/batch_progress.h"
#include "MMMConverterS2KF/batch/manifest.h"

namespace mmm_converter {

/// Of which entries a page is written.
struct ReportChoice {
  bool all = false;
  int worst = 20;  ///< so many with the largest mean distance
};

struct BatchOptions {
  std::string output;  ///< folder
  int jobs = 1;
  std::uint64_t memory = 0;    ///< [bytes] for all jobs together
  bool resume = false;         ///< keep what is done and unchanged
  bool retry_crashed = false;  ///< with resume: those, too, that ended the process of a run
  bool fail_fast = false;      ///< end with the first failure
  int shard = 1, shards = 1;
  ReportChoice reports;
};

/// How a run ended.
struct BatchOutcome {
  int converted = 0;
  int failed = 0;
  int unchanged = 0;  ///< done in an earlier run
  int not_done = 0;   ///< the run ended before them
  double seconds = 0;
  int signal = 0;        ///< that ended it; 0: none
  std::string obstacle;  ///< why it ended early, for users; empty: it did not, or by a signal
};

/// Converts the entries of a manifest, or of one of its shards, into the output folder; a line in
/// the shard's journal for each that has ended. An entry that can't be converted fails alone.
/// @throws Error where the folder or journal can't be written; nothing is converted then.
BatchOutcome ConvertBatch(const BatchManifest& manifest, const BatchOptions& options,
                          BatchProgress* progress);

}  // namespace mmm_converter
