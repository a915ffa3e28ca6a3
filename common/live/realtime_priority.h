// SPDX-License-Identifier: MIT
#pragma once

namespace mmm_converter {

/// Real-time priority (SCHED_FIFO) of this thread, as long as it exists.
class RealtimePriority {
 public:
  /// priority: 0: as it is. for_children: threads that it starts have it, too.
  RealtimePriority(int priority, bool for_children);
  ~RealtimePriority();
  RealtimePriority(const RealtimePriority&) = delete;
  RealtimePriority& operator=(const RealtimePriority&) = delete;

  bool is_given() const { return is_given_; }  ///< false: errno says why

 private:
  bool is_given_ = false;
};

}  // namespace mmm_converter
