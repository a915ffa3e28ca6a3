// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace mmm_converter {

/// The files that a command reads and those that it will write, named before any work and checked
/// once: no output replaces a file that is read or another output, and the system would let each be
/// written, as far as can be told. Empty names stand for files that are not asked for. Devices and
/// pipes are in nobody's way.
class OutputPlan {
 public:
  void Read(const std::string& file);
  void Write(const std::string& file);
  /// A file whose folder is made for it where there is none.
  void WriteIntoFolder(const std::string& file);
  /// A file that may replace `input`: what it keeps of that has been read before.
  void Rewrite(const std::string& file, const std::string& input);

  /// @throws Error naming the file and what it would replace; WriteError where one can't be
  /// written.
  void Check() const;

 private:
  struct Output {
    std::string file;
    std::string replaced;  // the input that it may replace; empty: none
    bool makes_folder = false;
  };
  void CheckIsNoInput(const Output& output) const;

  std::vector<std::string> inputs_;
  std::vector<Output> outputs_;
};

}  // namespace mmm_converter
