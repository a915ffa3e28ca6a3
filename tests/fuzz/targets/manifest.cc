// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/manifest.h"

#include "tests/fuzz/fuzz_target.h"

namespace mmm_converter::testing {

void ReadManifestBytes(std::string_view bytes) {
  const BatchManifest manifest = ParseManifest(std::string(bytes), kInputName);
  std::set<std::string> ids;
  for (const BatchEntry& entry : manifest.entries) {
    Require(ids.insert(entry.id).second, "ids that are unique");
    Require(!entry.id.empty() && entry.id.front() != '/' && entry.id != ".." &&
                entry.id.find("../") == std::string::npos,
            "outputs in the output folder");
  }
  Require(ShardOf(manifest.entries, 1, 2).size() + ShardOf(manifest.entries, 2, 2).size() ==
              manifest.entries.size(),
          "every entry in one shard");
}

}  // namespace mmm_converter::testing
