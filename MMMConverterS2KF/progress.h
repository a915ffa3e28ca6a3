// SPDX-License-Identifier: MIT
#pragma once

namespace mmm_converter {

/// A bar on stderr; nothing where stderr is not a terminal.
class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar() { Clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void Show(int done, int all);
  void Clear();

 private:
  bool is_terminal_;
  int percent_ = -1;  // what the terminal shows; -1: nothing
};

}  // namespace mmm_converter
