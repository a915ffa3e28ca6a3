// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/batch_progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "MMMConverterS2KF/log.h"

namespace mmm_converter {
namespace {

constexpr int kWidth = 30;
constexpr const char* kEraseLine = "\r\033[K";
constexpr std::chrono::milliseconds kBetweenDrawings(100);

}  // namespace

BatchProgress::BatchProgress(const std::string& unit)
    : unit_(unit),
      is_terminal_(isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()) {}

BatchProgress::~BatchProgress() { Erase(); }

void BatchProgress::Start(int all) {
  const std::scoped_lock lock(mutex_);
  all_ = all;
  done_ = failed_ = unchanged_ = 0;
  start_ = drawn_ = std::chrono::steady_clock::now();
  Draw(true);
}

void BatchProgress::Converted(const std::string& id, const std::string& figures) {
  const std::scoped_lock lock(mutex_);
  ++done_;
  if (!is_terminal_) LogInfo(fmt::format("{} {}: {}", Count(), id, figures));
  Draw(done_ == all_);
}

void BatchProgress::Failed(const std::string& reason) {
  const std::scoped_lock lock(mutex_);
  ++done_;
  ++failed_;
  Erase();
  LogError(fmt::format("{} {}", Count(), reason));
  Draw(true);
}

void BatchProgress::Unchanged() {
  const std::scoped_lock lock(mutex_);
  ++done_;
  ++unchanged_;
  Draw(done_ == all_);
}

void BatchProgress::Warn(const std::string& message) {
  const std::scoped_lock lock(mutex_);
  Erase();
  LogWarning(message);
  Draw(true);
}

double BatchProgress::Seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

std::string BatchProgress::Count() const { return fmt::format("[{}/{}]", done_, all_); }

void BatchProgress::Draw(bool at_once) {
  const auto now = std::chrono::steady_clock::now();
  if (!is_terminal_ || all_ <= 0 || (!at_once && now - drawn_ < kBetweenDrawings)) return;
  drawn_ = now;
  const int worked = done_ - unchanged_;
  const double rate = worked / std::max(Seconds(), 1e-3);  // [1/s]
  std::string text = fmt::format("{}[{:<{}}] {}/{} {}", kEraseLine,
                                 std::string(static_cast<long>(kWidth) * done_ / all_, '='), kWidth,
                                 done_, all_, unit_);
  if (failed_ > 0) text += fmt::format(", {} failed", failed_);
  if (worked > 0 && done_ < all_) {
    text += fmt::format(", {:.3g} a second, {} left", rate, FormatDuration((all_ - done_) / rate));
  }
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
  is_drawn_ = true;
}

void BatchProgress::Erase() {
  if (is_drawn_) std::fputs(kEraseLine, stderr);
  is_drawn_ = false;
}

std::string FormatDuration(double seconds) {
  constexpr long kMinute = 60;
  constexpr long kHour = 60 * kMinute;
  constexpr long kDay = 24 * kHour;
  const long whole = std::lround(seconds);
  if (whole < kMinute) return fmt::format("{:.1f} s", seconds);
  if (whole < kHour) return fmt::format("{} min {} s", whole / kMinute, whole % kMinute);
  if (whole < kDay) return fmt::format("{} h {} min", whole / kHour, whole % kHour / kMinute);
  return fmt::format("{} d {} h", whole / kDay, whole % kDay / kHour);
}

}  // namespace mmm_converter
