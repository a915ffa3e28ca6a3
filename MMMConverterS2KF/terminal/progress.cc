// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/terminal/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <string>

namespace mmm_converter {
namespace {

constexpr int kWidth = 50;
constexpr const char* kEraseLine = "\r\033[K";
constexpr std::chrono::milliseconds kBetweenStages(100);

}  // namespace

ProgressBar::ProgressBar(const char* unit)
    : unit_(unit), is_terminal_(isatty(STDERR_FILENO) == 1) {}

void ProgressBar::Show(int done, int all, const std::string& stage) {
  if (!is_terminal_ || all <= 0) return;
  const int percent = static_cast<int>(100LL * done / all);
  const auto now = std::chrono::steady_clock::now();
  const bool is_new_stage = stage != stage_ && now - drawn_ >= kBetweenStages;
  if (percent == percent_ && !is_new_stage) return;
  percent_ = percent;
  stage_ = stage;
  drawn_ = now;
  const int filled = kWidth * percent / 100;
  fmt::print(stderr, "{}[{:<{}}] {}/{} {}{}{}", kEraseLine, std::string(filled, '='), kWidth, done,
             all, unit_, stage.empty() ? "" : ": ", stage);
  std::fflush(stderr);
}

void ProgressBar::Clear() {
  if (percent_ >= 0) std::fputs(kEraseLine, stderr);
  percent_ = -1;
}

StatusLine::StatusLine() : is_terminal_(isatty(STDERR_FILENO) == 1) {}

void StatusLine::Show(const std::string& text) {
  if (!is_terminal_ || text == shown_) return;
  fmt::print(stderr, "{}{}", kEraseLine, text);
  std::fflush(stderr);
  shown_ = text;
}

void StatusLine::Clear() {
  if (!shown_.empty()) std::fputs(kEraseLine, stderr);
  shown_.clear();
}

}  // namespace mmm_converter
