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

}  // namespace mmm_converter
