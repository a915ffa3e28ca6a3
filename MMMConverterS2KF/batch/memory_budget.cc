// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/memory_budget.h"

#include <fmt/format.h>

#include "common/io/recording/recording_formats.h"
#include "common/support/error.h"
#include "common/support/machine.h"
#include "common/support/text.h"

namespace mmm_converter {

MemoryBudget::Part MemoryBudget::Take(const std::string& file, std::uint64_t bytes) {
  if (bytes > bytes_) {
    throw Error(
        fmt::format("{}: may need {} of memory, more than the {} allowed; allow more with "
                    "--memory, or convert a part with frames",
                    file, FormatByteSize(bytes), FormatByteSize(bytes_)));
  }
  std::unique_lock lock(mutex_);
  freed_.wait(lock, [&] { return taken_ + bytes <= bytes_; });
  taken_ += bytes;
  return Part(this, bytes);
}

void MemoryBudget::GiveBack(std::uint64_t bytes) {
  {
    const std::scoped_lock lock(mutex_);
    taken_ -= bytes;
  }
  freed_.notify_all();
}

std::uint64_t ConversionMemory(const std::string& file, std::uint64_t bytes, bool with_page) {
  // Smoothing keeps the beliefs of 1000 frames, 68 kB each.
  constexpr std::uint64_t kLeast = std::uint64_t{112} << 20;
  const RecordingFormat* format = FindFormatOfName(file);
  const RecordingFormat& likely = format != nullptr ? *format : RecordingFormats().front();
  return kLeast + (with_page ? 2 : 1) * static_cast<std::uint64_t>(likely.memory_factor) * bytes;
}

}  // namespace mmm_converter
