// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <tuple>
#include <vector>

namespace mmm_converter {

/// Something that a user should know of an input that is used nevertheless.
struct Warning {
  std::string file;    ///< that it is about; empty: not known
  std::string motion;  ///< of that file; empty: the file as a whole
  std::string text;    ///< complete without the above
};

/// The one place where readers and deciders say what they have noticed, in that order. It is handed
/// down as `Warnings* warnings`; null: nobody listens.
class Warnings {
 public:
  /// About the file and motion of the innermost WarningContext.
  void Add(std::string text);
  /// As Add, the first ten of a kind about one file and motion; of those beyond there is one that
  /// counts them: "5 more parameters that can't be read". kind: what that says, in plural.
  void AddOfKind(const std::string& kind, std::string text);
  void Append(const Warnings& more);
  /// Those whose text is not there yet.
  void AppendNew(const Warnings& more);

  const std::vector<Warning>& all() const { return all_; }
  std::vector<std::string> texts() const;
  bool empty() const { return all_.empty(); }

 private:
  friend class WarningContext;

  struct Kind {
    long count = 0;
    std::size_t summary = 0;  // in all_, of those beyond the tenth
  };

  std::vector<Warning> all_;
  std::map<std::tuple<std::string, std::string, std::string>, Kind> kinds_;  // file, motion, kind
  std::string file_, motion_;
};

/// warnings->Add(text), if anybody listens.
void Warn(Warnings* warnings, std::string text);

void WarnOfKind(Warnings* warnings, const std::string& kind, std::string text);

/// What is added while it lives is about this file, and this motion of it. warnings may be null.
class WarningContext {
 public:
  WarningContext(Warnings* warnings, std::string file, std::string motion = {});
  ~WarningContext();
  WarningContext(const WarningContext&) = delete;
  WarningContext& operator=(const WarningContext&) = delete;

 private:
  Warnings* warnings_;
  std::string file_, motion_;  // of the context around it
};

/// A value that was read once, and what there was to say then: to be said again at each use.
template <typename T>
struct WithWarnings {
  T value{};
  Warnings warnings;
};

}  // namespace mmm_converter
