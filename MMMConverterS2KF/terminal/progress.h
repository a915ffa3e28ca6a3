// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
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

  /// stage: what is being done; may be empty. Drawn at a new percent, and at another stage ten
  /// times a second at most.
  void Show(int done, int all, const std::string& stage = "");
  void Clear();
  bool is_terminal() const { return is_terminal_; }

 private:
  const char* unit_;
  bool is_terminal_;
  int percent_ = -1;  // what the terminal shows; -1: nothing
  std::string stage_;
  std::chrono::steady_clock::time_point drawn_;
};

/// A line on stderr that is drawn over again; nothing where stderr is not a terminal.
class StatusLine {
 public:
  StatusLine();
  ~StatusLine() { Clear(); }
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  void Show(const std::string& text);
  void Clear();

 private:
  bool is_terminal_;
  std::string shown_;
};

}  // namespace mmm_converter
