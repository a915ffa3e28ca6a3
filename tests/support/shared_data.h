// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

/// Path of a real file below ../shared/data, or skips the test where the folder does not exist.
#define MMM_CONVERTER_NEEDS_SHARED_DATA()                                               \
  if (!std::filesystem::exists(MMM_CONVERTER_SHARED_DATA "/data")) {                    \
    GTEST_SKIP() << "needs the real files in " << MMM_CONVERTER_SHARED_DATA << "/data"; \
  }

namespace mmm_converter::testing {

inline std::string SharedData(const std::string& path) {
  return std::string(MMM_CONVERTER_SHARED_DATA "/data/") + path;
}

inline std::string SourcePath(const std::string& path) {
  return std::string(MMM_CONVERTER_SOURCE_DIR "/") + path;
}

}  // namespace mmm_converter::testing
