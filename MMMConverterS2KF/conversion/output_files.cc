// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/conversion/output_files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <set>

#include "common/support/error.h"

namespace mmm_converter {

namespace fs = std::filesystem;

void CheckIsNoInput(const std::string& output, const std::vector<std::string>& inputs) {
  for (const std::string& input : inputs) {
    std::error_code failure;
    if (!fs::equivalent(output, input, failure)) continue;
    throw Error(fmt::format("{}: is read, and would be lost; give another file", output));
  }
}

void CheckCanBeWritten(const std::string& output) {
  std::error_code failure;
  if (output.empty() || fs::is_other(output, failure)) return;
  if (fs::is_directory(output, failure)) throw WriteError(output, EISDIR);
  const fs::path file = fs::weakly_canonical(fs::absolute(output), failure);
  const std::string folder = (failure ? fs::absolute(output) : file).parent_path().string() + "/.";
  if (access(folder.c_str(), W_OK | X_OK) != 0) throw WriteError(output, errno);
}

void CheckAreDifferentFiles(const std::vector<std::string>& outputs) {
  std::set<fs::path> files;
  for (const std::string& output : outputs) {
    std::error_code failure;
    if (output.empty() || fs::is_other(output, failure)) continue;
    const fs::path file = fs::weakly_canonical(fs::absolute(output), failure);
    if (failure || files.insert(file).second) continue;
    throw Error(fmt::format("{}: is to hold two outputs; give each its own file", output));
  }
}

}  // namespace mmm_converter
