// SPDX-License-Identifier: MIT
#pragma once

#include <csignal>
#include <memory>
#include <string>
#include <vector>

#include "MMMConverterS2KF/batch/journal.h"

namespace mmm_converter {

/// What is noted of the entry that a thread converts if the process ends meanwhile: by a signal
/// such as that of a segmentation fault, as a plugin can cause it, or by exit(). The line goes to a
/// journal of its own, so that --resume goes on after the entry. A process that is killed (SIGKILL,
/// no power) notes nothing. One at a time in a thread, which also updates and ends it.
class CrashNote {
 public:
  /// What runs now, as far as it is known yet.
  CrashNote(const std::string& folder, int shard, int shards, const JournalRecord& running);
  ~CrashNote();
  CrashNote(const CrashNote&) = delete;
  CrashNote& operator=(const CrashNote&) = delete;

  /// More is known of it.
  void Update(JournalRecord running);

 private:
  friend struct CrashNotes;
  struct Text;

  std::string file_;
  std::unique_ptr<const Text> text_;
  std::vector<char> stack_ = std::vector<char>(std::size_t{1} << 16);  // of handlers
  stack_t old_stack_{};
};

/// Notes are written while this exists. One at a time.
class CrashWatch {
 public:
  CrashWatch();
  ~CrashWatch();  ///< signals do again what they did before
  CrashWatch(const CrashWatch&) = delete;
  CrashWatch& operator=(const CrashWatch&) = delete;
};

}  // namespace mmm_converter
