// SPDX-License-Identifier: MIT
#include "common/support/opened_files.h"

#include <filesystem>

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

thread_local OpenedFiles* innermost = nullptr;

std::string Resolved(const std::string& file) {
  std::error_code failure;
  const fs::path canonical = fs::canonical(file, failure);
  if (!failure) return canonical.string();
  const fs::path absolute = fs::absolute(file, failure);
  return failure ? file : absolute.string();
}

}  // namespace

OpenedFiles::OpenedFiles() : around_(innermost) { innermost = this; }

OpenedFiles::~OpenedFiles() {
  innermost = around_;
  if (around_ != nullptr) around_->files_.merge(files_);
}

void OpenedFiles::Note(const std::string& file) {
  if (innermost != nullptr) innermost->files_.insert(Resolved(file));
}

void OpenedFiles::Note(const std::set<std::string>& files) {
  if (innermost != nullptr) innermost->files_.insert(files.begin(), files.end());
}

std::set<std::string> OpenedFiles::OfRun() {
  std::set<std::string> files;
  for (const OpenedFiles* one = innermost; one != nullptr; one = one->around_) {
    files.insert(one->files_.begin(), one->files_.end());
  }
  return files;
}

}  // namespace mmm_converter
