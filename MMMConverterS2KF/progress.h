// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace mmm_converter {

/// A bar on stderr; nothing where stderr is not a terminal.
class ProgressBar {
 public:
  /// unit: what is counted, "frames".
  explicit ProgressBar(const char* unit);
  ~ProgressBar() { Clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// stage: what is being done; may be empty.
  void Show(int done, int all, const std::string& stage = "");
  void Clear();

 private:
  const char* unit_;
  bool is_terminal_;
  int percent_ = -1;  // what the terminal shows; -1: nothing
};

}  // namespace mmm_converter
