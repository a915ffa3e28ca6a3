// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/memory_budget.h"

#include <fmt/format.h>

#include <filesystem>

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
  constexpr std::uint64_t kLeast = std::uint64_t{32} << 20;
  const std::string ending = ToLower(std::filesystem::path(file).extension().string());
  // A number takes four bytes in C3D, nine in TRC, and with its markup fifty in MMM.
  std::uint64_t factor = 8;
  if (ending == ".trc") factor = 5;
  if (ending == ".xml") factor = 2;
  return kLeast + (with_page ? 2 : 1) * factor * bytes;
}

}  // namespace mmm_converter
