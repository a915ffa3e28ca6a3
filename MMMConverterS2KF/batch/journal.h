// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>

#include "MMMConverterS2KF/batch/entry_result.h"
#include "MMMConverterS2KF/batch/file_state.h"
#include "common/support/line_file.h"

namespace mmm_converter {

/// What a journal says of an entry that has ended: converted, or failed.
struct JournalRecord {
  std::string id;
  std::int64_t time = 0;    ///< when it ended [ms since 1970]
  std::string fingerprint;  ///< see SharedInputs
  FileState recording;      ///< of converted ones
  /// Other files that were opened and that the fingerprint is not of, as only reading tells which:
  /// those that inputs name. By path from the recording's folder.
  std::map<std::string, FileState> inputs;
  std::map<std::string, FileState> outputs;  ///< by path in the output folder
  EntryResult result;
  bool crashed = false;  ///< the process ended while it ran; of failed ones
};

/// The file to which one shard's process adds a line when an entry has ended (JSON lines). Lines
/// stay when the process is killed or the disk is full.
class Journal {
 public:
  /// @throws Error where it can't be written or another process has it.
  Journal(const std::string& folder, int shard, int shards);

  /// The record's time is now, or just after the latest of the folder's journals when that was
  /// read, where the clock was set back. Not for several threads at a time. @throws WriteError
  void Append(JournalRecord record);
  /// Of a record that is made now.
  std::int64_t NextTime() const;

 private:
  LineFile file_;
  std::int64_t latest_;  // time of the last record [ms since 1970]
};

/// kind: of a journal beside the usual one.
std::string JournalFile(const std::string& folder, int shard, int shards,
                        const std::string& kind = "");

/// A journal's line, without its end.
std::string FormatJournalLine(const JournalRecord& record);

/// Of all journals of an output folder the latest record of each entry, by id. Lines that are not
/// understood are left out: their entries are done again. None where there is no such folder.
/// @throws Error where a journal can't be read.
std::unordered_map<std::string, JournalRecord> ReadJournals(const std::string& folder);

}  // namespace mmm_converter
