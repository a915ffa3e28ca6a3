// SPDX-License-Identifier: MIT
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace mmm_converter {

/// The files that a command reads and those that it will write: no output replaces a file that is
/// read or another output, and the system would let each be written, as far as can be told. Checked
/// before any work, and again once all is read: files that inputs name are known then
/// (OpenedFiles). Empty names stand for files that are not asked for. Devices are in nobody's way,
/// nor pipes.
class OutputPlan {
 public:
  void Read(const std::string& file);
  void Read(const std::set<std::string>& files);
  void Write(const std::string& file);
  /// A file that comes beside another that was asked for, and replaces only what begins so: what
  /// this program has written.
  void WriteBeside(const std::string& file, std::string_view begin);
  /// A file whose folder is made for it where there is none.
  void WriteIntoFolder(const std::string& file);
  /// A file that may replace `input`: what it keeps of that has been read before.
  void Rewrite(const std::string& file, const std::string& input);

  /// Files that this thread's run has opened are inputs, too.
  /// @throws Error naming the file and what it would replace; WriteError where one can't be
  /// written.
  void Check() const;

 private:
  struct Output {
    std::string file;
    std::string replaced;  // the input that it may replace; empty: none
    bool makes_folder = false;
    std::string own_begin = {};  // of what it may replace; empty: anything
  };
  void CheckIsNoInput(const Output& output) const;
  /// Of a file that two outputs have: whether one comes beside another; else empty.
  std::string WhyTwo(const std::string& file) const;

  std::vector<std::string> inputs_;
  std::vector<Output> outputs_;
};

/// @throws Error where there is such a file that begins otherwise; see OutputPlan::WriteBeside.
void CheckIsOwn(const std::string& file, std::string_view begin);

}  // namespace mmm_converter
