// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>

namespace mmm_converter {

/// Bad input. The message is complete for a user: where it is (file and line or byte), what was
/// found, what was expected, what to do. Only `main` catches and prints it.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message);
  ~Error() override;
};

/// A file can't be written.
class WriteError : public Error {
 public:
  /// error_number: errno
  WriteError(const std::string& path, int error_number);
  /// Whether other files of the same disk can't be written either: it is full, over a quota, broken
  /// or gone.
  bool concerns_disk() const;

 private:
  int error_number_;
};

}  // namespace mmm_converter
