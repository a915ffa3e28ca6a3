// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace mmm_converter {

/// Problems found while one file is read. All errors of the file are collected before they are
/// thrown together, one a line, each as `file:line: message` (`file: message` where line is 0).
class Diagnostics {
 public:
  explicit Diagnostics(std::string file) : file_(std::move(file)) {}

  void AddError(int line, const std::string& message);
  void AddWarning(int line, const std::string& message);

  /// @throws Error with all errors so far, if there are any.
  void ThrowIfErrors() const;

  const std::string& file() const { return file_; }
  const std::vector<std::string>& errors() const { return errors_; }
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  std::string file_;
  std::vector<std::string> errors_;
  std::vector<std::string> warnings_;
};

}  // namespace mmm_converter
