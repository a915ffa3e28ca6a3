// SPDX-License-Identifier: MIT
#include "common/support/output_plan.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <set>

#include "common/support/atomic_file.h"
#include "common/support/error.h"
#include "common/support/line_file.h"
#include "common/support/opened_files.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

bool AreSame(const std::string& a, const std::string& b) {
  std::error_code failure;
  return fs::equivalent(a, b, failure);
}

bool IsDevice(const std::string& file) {
  std::error_code failure;
  return fs::is_other(file, failure);
}

// The file that writing would make or replace; links are followed also where they lead to nothing
// yet.
fs::path Destination(const std::string& file) {
  constexpr int kMostLinks = 40;  // as Linux has it
  std::error_code failure;
  fs::path path = fs::absolute(file);
  for (int i = 0; i < kMostLinks && fs::is_symlink(path, failure); ++i) {
    path = path.parent_path() / fs::read_symlink(path, failure);
  }
  const fs::path canonical = fs::weakly_canonical(path, failure);
  return failure ? path : canonical;
}

// The outermost of the file's folders that is not there, else the file.
fs::path FirstToMake(fs::path file) {
  std::error_code failure;
  while (file.has_relative_path() && !fs::exists(file.parent_path(), failure)) {
    file = file.parent_path();
  }
  return file;
}

// name: as the user has it.
void CheckCanBeWritten(const fs::path& file, const std::string& name) {
  std::error_code failure;
  if (fs::is_directory(file, failure)) throw WriteError(name, EISDIR);
  struct stat unused {};
  if (::lstat(file.c_str(), &unused) != 0 && errno == ENAMETOOLONG) throw WriteError(name, errno);
  const std::string folder = file.parent_path().string() + "/.";
  if (access(folder.c_str(), W_OK | X_OK) != 0) throw WriteError(name, errno);
}

}  // namespace

void OutputPlan::Read(const std::string& file) {
  if (!file.empty()) inputs_.push_back(file);
}

void OutputPlan::Read(const std::set<std::string>& files) {
  inputs_.insert(inputs_.end(), files.begin(), files.end());
}

void OutputPlan::WriteBeside(const std::string& file, std::string_view begin) {
  if (!file.empty()) outputs_.push_back({file, "", false, std::string(begin)});
}

void OutputPlan::Write(const std::string& file) {
  if (!file.empty()) outputs_.push_back({file, "", false});
}

void OutputPlan::WriteIntoFolder(const std::string& file) {
  if (!file.empty()) outputs_.push_back({file, "", true});
}

void OutputPlan::Rewrite(const std::string& file, const std::string& input) {
  if (!file.empty()) outputs_.push_back({file, input, false});
}

void OutputPlan::CheckIsNoInput(const Output& output) const {
  std::set<std::string> inputs = OpenedFiles::OfRun();
  inputs.insert(inputs_.begin(), inputs_.end());
  for (const std::string& input : inputs) {
    if (!AreSame(output.file, input) || IsDevice(output.file)) continue;
    if (!output.replaced.empty() && AreSame(output.replaced, input)) continue;
    throw Error(fmt::format("{}: is read, and would be lost; give another file", output.file));
  }
}

std::string OutputPlan::WhyTwo(const std::string& file) const {
  const fs::path asked = Destination(file);
  const bool is_beside = std::any_of(outputs_.begin(), outputs_.end(), [&](const Output& one) {
    return !one.own_begin.empty() && Destination(one.file) == asked;
  });
  if (!is_beside) return "";
  for (const Output& one : outputs_) {
    const fs::path other = Destination(one.file);
    if (other != asked && other.parent_path() == asked.parent_path() &&
        other.stem() == asked.stem()) {
      return fmt::format(", one of which is written beside {}", one.file);
    }
  }
  return ", one of which is written beside another one";
}

void OutputPlan::Check() const {
  std::set<fs::path> files;
  for (const Output& output : outputs_) CheckIsNoInput(output);
  for (const Output& output : outputs_) {
    if (IsDevice(output.file) || files.insert(Destination(output.file)).second) continue;
    throw Error(fmt::format("{}: is to hold two outputs{}; give each its own file", output.file,
                            WhyTwo(output.file)));
  }
  for (const Output& output : outputs_) CheckIsOwn(output.file, output.own_begin);
  for (const Output& output : outputs_) {
    if (IsDevice(output.file)) {
      HoldPipe(output.file);
      continue;
    }
    const fs::path file = Destination(output.file);
    CheckCanBeWritten(output.makes_folder ? FirstToMake(file) : file, output.file);
  }
}

void CheckIsOwn(const std::string& file, std::string_view begin) {
  std::error_code failure;
  if (begin.empty() || !fs::exists(file, failure) || IsDevice(file)) return;
  if (FirstBytes(file, begin.size()) == begin) return;
  throw Error(
      fmt::format("{}: is there, was not written by this program, and would be replaced by what "
                  "comes beside another output; move it away, or give that another name",
                  file));
}

}  // namespace mmm_converter
