// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/journal.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "common/support/error.h"
#include "tests/fuzz/fuzz_target.h"

namespace mmm_converter::testing {

void ReadJournalBytes(std::string_view bytes) {
  const std::filesystem::path input = FileOf(bytes);
  const std::filesystem::path journal = input.parent_path() / "journal.jsonl";
  std::filesystem::rename(input, journal);
  const auto records = ReadJournals(input.parent_path());
  std::filesystem::remove(journal);
  for (const auto& [id, record] : records) {
    Require(id == record.id, "records by their ids");
    const Json json = ToJson(record.result);
    Require(FormatJsonLine(ToJson(ParseEntryResult(json))) == FormatJsonLine(json),
            "the same result when it is written and read again");
  }
  // What is not understood is left out: the entry is done again.
  if (records.empty()) throw Error(std::string(kInputName) + ": has no record");
}

}  // namespace mmm_converter::testing
