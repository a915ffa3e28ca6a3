// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/support/error.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// Problems found while one file is read. All errors of the file are collected before they are
/// thrown together, one a line, each as `file:line: message` (`file: message` where line is 0).
class Diagnostics {
 public:
  /// warnings: where AddWarning adds to, at once; may be null.
  explicit Diagnostics(std::string file, Warnings* warnings = nullptr)
      : file_(std::move(file)), warnings_(warnings) {}

  /// remedy: shown for the file as a whole, the first that there is.
  void AddError(int line, const std::string& message, Remedy remedy = Remedy::kNone);
  /// kind: of those that a file may have without end, in plural (Warnings::AddOfKind).
  void AddWarning(int line, const std::string& message, const std::string& kind = "");

  /// @throws Error with all errors so far, if there are any.
  void ThrowIfErrors() const;

  /// Whether further errors are only counted, so that what they suggest need not be looked for.
  bool is_full() const { return errors_.size() >= kMostErrorsShown; }
  const std::string& file() const { return file_; }
  const std::vector<std::string>& errors() const { return errors_; }

 private:
  static constexpr std::size_t kMostErrorsShown = 20;

  std::string file_;
  std::vector<std::string> errors_;
  Warnings* warnings_;
  Remedy remedy_ = Remedy::kNone;
};

}  // namespace mmm_converter
