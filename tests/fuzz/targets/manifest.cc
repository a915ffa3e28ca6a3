// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/manifest.h"

#include <algorithm>
#include <filesystem>

#include "tests/fuzz/fuzz_target.h"

namespace mmm_converter::testing {

void ReadManifestBytes(std::string_view bytes) {
  const BatchManifest manifest = ParseManifest(std::string(bytes), kInputName);
  std::set<std::string> ids;
  for (const BatchEntry& entry : manifest.entries) {
    Require(ids.insert(entry.id).second, "ids that are unique");
    const std::filesystem::path output(entry.id);
    Require(output.is_relative() && !output.empty() &&
                std::find(output.begin(), output.end(), "..") == output.end(),
            "outputs in the output folder");
  }
  Require(ShardOf(manifest.entries, 1, 2).size() + ShardOf(manifest.entries, 2, 2).size() ==
              manifest.entries.size(),
          "every entry in one shard");
}

}  // namespace mmm_converter::testing
