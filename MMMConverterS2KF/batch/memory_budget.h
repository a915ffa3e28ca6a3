// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>

namespace mmm_converter {

/// Memory that conversions share; each takes its part before it begins.
class MemoryBudget {
 public:
  /// [bytes]
  explicit MemoryBudget(std::uint64_t bytes) : bytes_(bytes) {}

  /// A part, given back at the end of its scope.
  class Part {
   public:
    Part(MemoryBudget* budget, std::uint64_t bytes) : budget_(budget), bytes_(bytes) {}
    ~Part() { budget_->GiveBack(bytes_); }
    Part(const Part&) = delete;
    Part& operator=(const Part&) = delete;

   private:
    MemoryBudget* budget_;
    std::uint64_t bytes_;
  };

  /// Waits until so much is free.
  /// @throws Error where the whole budget is smaller; `file` is named in the message.
  Part Take(const std::string& file, std::uint64_t bytes);

 private:
  void GiveBack(std::uint64_t bytes);

  std::uint64_t bytes_;
  std::uint64_t taken_ = 0;
  std::mutex mutex_;
  std::condition_variable freed_;
};

/// What converting a recording of so many bytes takes at most [bytes], measured on ten minutes of
/// 53 markers and rounded up; with_page: and writing its page.
std::uint64_t ConversionMemory(const std::string& file, std::uint64_t bytes, bool with_page);

}  // namespace mmm_converter
