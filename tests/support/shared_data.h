// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

/// Skips the test where there are no real files. It is the first line of each test of a suite whose
/// name has "Real": suites of their own, as nothing else may depend on these files.
#define MMM_CONVERTER_NEEDS_SHARED_DATA()                                                 \
  if (!std::filesystem::exists(mmm_converter::testing::SharedData(""))) {                 \
    GTEST_SKIP() << "needs the real files in " << mmm_converter::testing::SharedData(""); \
  }

namespace mmm_converter::testing {

inline std::string SourcePath(const std::string& path) {
  return std::string(MMM_CONVERTER_SOURCE_DIR "/") + path;
}

/// Path of a real file below data/ of $MMM_CONVERTER_SHARED_DATA, or of ../shared beside the
/// project.
inline std::string SharedData(const std::string& path) {
  const ::testing::TestSuite* suite = ::testing::UnitTest::GetInstance()->current_test_suite();
  if (suite != nullptr && std::string(suite->name()).find("Real") == std::string::npos) {
    ADD_FAILURE() << "only suites whose name has \"Real\" may ask for real files";
  }
  const char* folder = std::getenv("MMM_CONVERTER_SHARED_DATA");
  return (folder == nullptr ? SourcePath("../shared") : std::string(folder)) + "/data/" + path;
}

}  // namespace mmm_converter::testing
