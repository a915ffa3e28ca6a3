// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <string>

namespace mmm_converter {
namespace {

constexpr int kWidth = 50;
constexpr const char* kEraseLine = "\r\033[K";

}  // namespace

ProgressBar::ProgressBar() : is_terminal_(isatty(STDERR_FILENO) == 1) {}

void ProgressBar::Show(int done, int all) {
  if (!is_terminal_ || all <= 0) return;
  const int percent = static_cast<int>(100LL * done / all);
  if (percent == percent_) return;
  percent_ = percent;
  const int filled = kWidth * percent / 100;
  fmt::print(stderr, "{}[{:<{}}] {}/{} frames", kEraseLine, std::string(filled, '='), kWidth, done,
             all);
  std::fflush(stderr);
}

void ProgressBar::Clear() {
  if (percent_ >= 0) std::fputs(kEraseLine, stderr);
  percent_ = -1;
}

}  // namespace mmm_converter
