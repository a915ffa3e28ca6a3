// SPDX-License-Identifier: MIT
#include "common/support/data_directory.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "common/support/error.h"

namespace mmm_converter {

namespace fs = std::filesystem;

std::string LibraryFile() {
  Dl_info info = {};
  if (dladdr(reinterpret_cast<const void*>(&LibraryFile), &info) == 0 ||
      info.dli_fname == nullptr) {
    throw Error(
        "can't find out where libmmm_converter_common is; set MMM_CONVERTER_DATA and "
        "MMM_CONVERTER_PLUGIN_PATH to the folders of its data and plugins");
  }
  std::error_code failure;
  const fs::path library = fs::canonical(info.dli_fname, failure);
  return (failure ? fs::absolute(info.dli_fname) : library).string();
}

std::string LibraryDirectory() { return fs::path(LibraryFile()).parent_path().string(); }

std::string DataDirectory() {
  if (const char* folder = std::getenv("MMM_CONVERTER_DATA"); folder != nullptr && *folder != 0) {
    return folder;
  }
  return (fs::path(LibraryDirectory()) / MMM_CONVERTER_DATA_FROM_LIBRARY)
      .lexically_normal()
      .string();
}

std::string DataFile(const std::string& relative_path) {
  const fs::path path = fs::path(DataDirectory()) / relative_path;
  std::error_code failure;
  if (!fs::exists(path, failure)) {
    throw Error(
        fmt::format("{}: no such file, but it belongs to the installation; reinstall "
                    "MMMConverterS2KF or set MMM_CONVERTER_DATA to the folder of its data",
                    path.string()));
  }
  return path.string();
}

}  // namespace mmm_converter
