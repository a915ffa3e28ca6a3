// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/batch_progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "MMMConverterS2KF/terminal/log.h"

namespace mmm_converter {

void BatchProgress::Start(int all) {
  const std::scoped_lock lock(mutex_);
  all_ = all;
  done_ = failed_ = unchanged_ = 0;
  start_ = std::chrono::steady_clock::now();
  Draw();
}

void BatchProgress::Converted(const std::string& id, const std::string& figures) {
  const std::scoped_lock lock(mutex_);
  ++done_;
  if (!bar_.is_terminal()) LogInfo(fmt::format("{} {}: {}", Count(), id, figures));
  Draw();
}

void BatchProgress::Failed(const std::string& reason) {
  const std::scoped_lock lock(mutex_);
  ++done_;
  ++failed_;
  bar_.Clear();
  LogError(fmt::format("{} {}", Count(), reason));
  Draw();
}

void BatchProgress::Unchanged() {
  const std::scoped_lock lock(mutex_);
  ++done_;
  ++unchanged_;
  Draw();
}

void BatchProgress::Say(const std::string& message) {
  const std::scoped_lock lock(mutex_);
  bar_.Clear();
  LogInfo(message);
  Draw();
}

void BatchProgress::Warn(const std::string& message) {
  const std::scoped_lock lock(mutex_);
  bar_.Clear();
  LogWarning(message);
  Draw();
}

double BatchProgress::Seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

std::string BatchProgress::Count() const { return fmt::format("[{}/{}]", done_, all_); }

void BatchProgress::Draw() {
  const int worked = done_ - unchanged_;
  const double rate = worked / std::max(Seconds(), 1e-3);  // [1/s]
  std::string text;
  if (failed_ > 0) text = fmt::format("{} failed", failed_);
  if (worked > 0 && done_ < all_) {
    text += fmt::format("{}{:.3g} a second, {} left", text.empty() ? "" : ", ", rate,
                        FormatDuration((all_ - done_) / rate));
  }
  bar_.Show(done_, all_, text);
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
