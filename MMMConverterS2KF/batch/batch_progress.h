// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <mutex>
#include <string>

#include "MMMConverterS2KF/terminal/progress.h"

namespace mmm_converter {

/// What a batch says while it works, on stderr: on a terminal one line with rate and time left,
/// else a line for each entry that has ended. For several threads.
class BatchProgress {
 public:
  /// all: entries. The clock starts.
  void Start(int all);
  void Converted(const std::string& id, const std::string& figures);
  void Failed(const std::string& reason);
  void Unchanged();
  /// Messages; the progress line stays below.
  void Say(const std::string& message);
  void Warn(const std::string& message);
  double Seconds() const;  ///< since Start

 private:
  void Draw();
  std::string Count() const;

  ProgressBar bar_{"recordings"};
  int all_ = 0, done_ = 0, failed_ = 0, unchanged_ = 0;
  std::chrono::steady_clock::time_point start_;
  std::mutex mutex_;
};

/// "2 d 3 h", "1 h 20 min", "4 min 5 s", "12.3 s"
std::string FormatDuration(double seconds);

}  // namespace mmm_converter
