// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/io/xml/xml_document.h"
#include "common/support/diagnostics.h"

namespace mmm_converter {

/// The content of a file that a model includes, by its path relative to the model's folder, or an
/// absolute one. Nothing: there is none. @throws Error where it can't be read.
using MjcfPartReader = std::function<std::optional<std::string>(const std::string& path)>;

/// An MJCF with all that it includes in place, and what is said of it.
class MjcfText {
 public:
  /// @throws Error with the file of diagnostics: not XML, no MJCF, files that are not there, are
  ///         included twice (or include themselves), are too many, or nested too deeply.
  MjcfText(std::string_view content, const MjcfPartReader& read_part, Diagnostics* diagnostics);

  const XmlElement& root() const { return root_; }

  const std::string& file() const { return diagnostics_->file(); }

  void Fail(const XmlElement& element, const std::string& text) { Fail(element.line, text); }
  void Fail(int line, const std::string& text);  ///< line: of an element of root()
  void Warn(const XmlElement& element, const std::string& text);
  void Warn(const std::string& text) { diagnostics_->AddWarning(0, text); }
  void ThrowIfErrors() const { diagnostics_->ThrowIfErrors(); }

 private:
  XmlElement Parse(std::string_view content, const std::string& path);
  XmlElement Include(const XmlElement& include);
  void Expand(XmlElement* element, int depth);
  [[noreturn]] void Throw(const XmlElement& element, const std::string& text);
  const std::string& FileOf(int line) const;

  const MjcfPartReader& read_part_;
  Diagnostics* diagnostics_;
  std::vector<std::string>
      files_;              ///< paths; the model's is empty. Lines of root_ tell which it is
  std::size_t bytes_ = 0;  ///< of all files
  XmlElement root_;
};

}  // namespace mmm_converter
