// SPDX-License-Identifier: MIT
#pragma once

#include <set>
#include <string>

namespace mmm_converter {

/// Collects what this thread opens for reading while it lives, nested ones into those around them,
/// too: the files on the command line and those that files name, which no reader has to hand on.
/// OutputPlan::Check takes them for what the run reads.
class OpenedFiles {
 public:
  OpenedFiles();
  ~OpenedFiles();
  OpenedFiles(const OpenedFiles&) = delete;
  OpenedFiles& operator=(const OpenedFiles&) = delete;

  /// Absolute, links resolved.
  const std::set<std::string>& files() const { return files_; }

  /// A reader has opened this file, or what is used now was read of it before.
  static void Note(const std::string& file);
  static void Note(const std::set<std::string>& files);

  /// Of the outermost that lives in this thread; none where there is none.
  static std::set<std::string> OfRun();

 private:
  OpenedFiles* around_;
  std::set<std::string> files_;
};

}  // namespace mmm_converter
