// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace mmm_converter::testing {

/// A new, empty folder in the machine's folder for temporary files; removed with all that is in it
/// at the end of its scope.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  /// Without a slash at its end.
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// The temporary folder of the test that is running; removed when the test has ended.
const std::string& TestFolder();

}  // namespace mmm_converter::testing
