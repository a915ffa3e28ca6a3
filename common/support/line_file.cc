// SPDX-License-Identifier: MIT
#include "common/support/line_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

void SyncFolder(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

LineFile::LineFile(const std::string& path) : path_(path) {
  descriptor_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) throw WriteError(path, errno);
  // A file system without locks has to do without.
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(descriptor_);
    throw Error(fmt::format("{}: another process is writing to it; wait until it has ended", path));
  }
  CutOffPartOfLine();
  SyncFolder(path);
}

LineFile::~LineFile() { ::close(descriptor_); }

void LineFile::CutOffPartOfLine() {
  size_ = ::lseek(descriptor_, 0, SEEK_END);
  char last = '\n';
  const auto read_last = [&] { return ::pread(descriptor_, &last, 1, size_ - 1) == 1; };
  while (size_ > 0 && read_last() && last != '\n') --size_;
  [[maybe_unused]] const int cut = ::ftruncate(descriptor_, size_);
}

void LineFile::Append(std::string_view line) {
  const std::string text = std::string(line) + "\n";
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t written = ::pwrite(descriptor_, text.data() + done, text.size() - done,
                                     size_ + static_cast<long>(done));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) break;
    done += static_cast<std::size_t>(written);
  }
  if (done < text.size() || ::fdatasync(descriptor_) != 0) {
    const WriteError failure(path_, errno);
    [[maybe_unused]] const int cut = ::ftruncate(descriptor_, size_);
    throw failure;
  }
  size_ += static_cast<long>(text.size());
}

void ForEachLine(const std::string& path, const std::function<void(std::string_view)>& visit) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    if (!std::filesystem::exists(path)) return;
    throw Error(fmt::format("{}: can't be read: {}", path, std::strerror(errno)));
  }
  std::string line;
  while (std::getline(file, line)) {
    if (!file.eof()) visit(line);
  }
}

}  // namespace mmm_converter
