// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <mutex>
#include <string>

namespace mmm_converter {

/// What a batch says while it works, on stderr: on a terminal one line with rate and time left,
/// else a line for each entry that has ended. For several threads.
class BatchProgress {
 public:
  explicit BatchProgress(const std::string& unit);
  ~BatchProgress();
  BatchProgress(const BatchProgress&) = delete;
  BatchProgress& operator=(const BatchProgress&) = delete;

  /// all: entries. The clock starts.
  void Start(int all);
  void Converted(const std::string& id, const std::string& figures);
  void Failed(const std::string& reason);
  void Unchanged();
  /// A message; the progress line stays below.
  void Warn(const std::string& message);
  double Seconds() const;  ///< since Start

 private:
  void Draw(bool at_once);
  void Erase();
  std::string Count() const;

  std::string unit_;
  bool is_terminal_;
  bool is_drawn_ = false;
  int all_ = 0, done_ = 0, failed_ = 0, unchanged_ = 0;
  std::chrono::steady_clock::time_point start_, drawn_;
  std::mutex mutex_;
};

/// "2 d 3 h", "1 h 20 min", "4 min 5 s", "12.3 s"
std::string FormatDuration(double seconds);

}  // namespace mmm_converter
