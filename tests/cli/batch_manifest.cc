// SPDX-License-Identifier: MIT
#include "tests/cli/batch_manifest.h"

#include <fmt/format.h>

#include <filesystem>

#include "tests/cli/program.h"
#include "tests/support/test_plugins.h"

namespace mmm_converter::testing {

namespace fs = std::filesystem;

std::string WriteManifest(int count, const std::string& attributes, const std::string& more) {
  fs::copy_file(Handstand(), TestFolder() + "/handstand.c3d", fs::copy_options::skip_existing);
  std::string xml = fmt::format("<Batch height_m='1.8' {}>", attributes);
  for (int i = 0; i < count; ++i) {
    xml += fmt::format("\n<Recording file='handstand.c3d' id='{}' frames='{}:{}'/>", i, 5 * i,
                       5 * i + 40);
  }
  std::string file = TestFolder() + "/manifest.xml";
  WriteText(file, xml + more + "\n</Batch>\n");
  return file;
}

std::string QuickConverter() {
  return fmt::format("config='' plugin='{}'", TestPlugin("test_converter"));
}

std::map<std::string, std::string> Contents(const std::string& folder) {
  std::map<std::string, std::string> contents;
  if (!fs::exists(folder)) return contents;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    contents[entry.path().lexically_relative(folder).string()] = ReadText(entry.path().string());
  }
  return contents;
}

}  // namespace mmm_converter::testing
