// SPDX-License-Identifier: MIT
#include "common/support/diagnostics.h"

#include <fmt/format.h>

namespace mmm_converter {
namespace {

std::string Located(const std::string& file, int line, const std::string& message) {
  return line > 0 ? fmt::format("{}:{}: {}", file, line, message)
                  : fmt::format("{}: {}", file, message);
}

}  // namespace

void Diagnostics::AddError(int line, const std::string& message, Remedy remedy) {
  errors_.push_back(Located(file_, line, message));
  if (remedy_ == Remedy::kNone) remedy_ = remedy;
}

void Diagnostics::AddWarning(int line, const std::string& message, const std::string& kind) {
  const WarningContext context(warnings_, file_);
  const std::string text = Located(file_, line, message);
  kind.empty() ? Warn(warnings_, text) : WarnOfKind(warnings_, kind, text);
}

void Diagnostics::ThrowIfErrors() const {
  if (errors_.empty()) return;
  std::string text = errors_.front();
  for (std::size_t i = 1; i < errors_.size() && i < kMostErrorsShown; ++i)
    text += "\n" + errors_[i];
  if (errors_.size() > kMostErrorsShown) {
    text += fmt::format("\n{}: {} more errors", file_, errors_.size() - kMostErrorsShown);
  }
  throw Error(text, remedy_);
}

}  // namespace mmm_converter
