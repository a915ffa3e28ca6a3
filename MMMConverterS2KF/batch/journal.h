// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "common/support/line_file.h"

namespace mmm_converter {

/// A recording's file as it was when it was converted.
struct RecordedFile {
  std::uint64_t bytes = 0;
  std::int64_t modified = 0;  ///< [ns]
  std::string hash;
};

/// What a journal says of an entry that has ended: converted, or failed.
struct JournalRecord {
  std::string id;
  bool converted = false;
  std::string fingerprint;                       ///< see SharedInputs
  RecordedFile recording;                        ///< of converted ones
  std::map<std::string, std::uint64_t> outputs;  ///< paths in the output folder, sizes [bytes]
  std::string result;                            ///< JSON object, see batch_result.h
};

/// The file to which one shard's process adds a line when an entry has ended (JSON lines). Lines
/// stay when the process is killed or the disk is full.
class Journal {
 public:
  /// fresh: what the journal has of an earlier run is dropped.
  /// @throws Error where it can't be written or another process has it.
  Journal(const std::string& folder, int shard, int shards, bool fresh)
      : file_(JournalFile(folder, shard, shards), fresh) {}

  /// Not for several threads at a time. @throws WriteError
  void Append(const JournalRecord& record);

 private:
  static std::string JournalFile(const std::string& folder, int shard, int shards);

  LineFile file_;
};

/// Visits the records of all journals of an output folder, of each entry the last one last. Lines
/// that are not understood are left out: their entries are done again.
/// @throws Error where a journal can't be read.
void ReadJournals(const std::string& folder, const std::function<void(JournalRecord)>& visit);

/// Size and time of a file; its hash is empty.
/// @throws Error where there is none.
RecordedFile InspectFile(const std::string& path);

/// Whether the file is what the record says: the same size and time, or else the same hash.
bool IsUnchanged(const std::string& path, const RecordedFile& recorded);

}  // namespace mmm_converter
