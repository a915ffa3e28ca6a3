// SPDX-License-Identifier: MIT
#include "common/support/line_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kReadBytes = std::size_t{1} << 16;

[[noreturn]] void ThrowNotRegular(const std::string& path) {
  throw Error(fmt::format(
      "{}: is not a regular file, but a device, a pipe or the like; move it away", path));
}

bool IsRegular(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
}

void SyncFolder(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

LineFile::LineFile(const std::string& path) : path_(path) {
  descriptor_ =
      ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK | O_NOCTTY | O_NOFOLLOW, 0666);
  if (descriptor_ < 0 && errno == ELOOP) {
    throw Error(fmt::format("{}: is a link; what is added here needs a file of its own", path));
  }
  if (descriptor_ < 0) throw WriteError(path, errno);
  if (!IsRegular(descriptor_)) {
    ::close(descriptor_);
    ThrowNotRegular(path);
  }
  // A file system without locks has to do without.
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(descriptor_);
    throw Error(fmt::format("{}: another process is writing to it; wait until it has ended", path));
  }
  SyncFolder(path);
}

LineFile::~LineFile() { ::close(descriptor_); }

void LineFile::CutOffPartOfLine() {
  if (size_ >= 0) return;
  size_ = ::lseek(descriptor_, 0, SEEK_END);
  char last = '\n';
  const auto read_last = [&] { return ::pread(descriptor_, &last, 1, size_ - 1) == 1; };
  while (size_ > 0 && read_last() && last != '\n') --size_;
  [[maybe_unused]] const int cut = ::ftruncate(descriptor_, size_);
}

void LineFile::Append(std::string_view line) {
  CutOffPartOfLine();
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
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (descriptor < 0 && errno == ENOENT) return;
  if (descriptor < 0) throw Error(fmt::format("{}: can't be read: {}", path, std::strerror(errno)));
  const std::unique_ptr<const int, void (*)(const int*)> closed(
      &descriptor, [](const int* opened) { ::close(*opened); });
  if (!IsRegular(descriptor)) ThrowNotRegular(path);
  std::string block(kReadBytes, '\0');
  std::string line;
  for (;;) {
    const ssize_t count = ::read(descriptor, block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw Error(fmt::format("{}: can't be read: {}", path, std::strerror(errno)));
    if (count == 0) return;
    std::string_view rest(block.data(), static_cast<std::size_t>(count));
    for (std::size_t end = rest.find('\n'); end != std::string_view::npos; end = rest.find('\n')) {
      line += rest.substr(0, std::min(end, kMostLineBytes - line.size()));
      visit(line);
      line.clear();
      rest.remove_prefix(end + 1);
    }
    line += rest.substr(0, std::min(rest.size(), kMostLineBytes - line.size()));
  }
}

std::string FirstBytes(const std::string& path, std::size_t most) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (descriptor < 0) return "";
  std::string bytes(most, '\0');
  std::size_t done = 0;
  while (done < most) {
    const ssize_t count = ::read(descriptor, bytes.data() + done, most - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    done += static_cast<std::size_t>(count);
  }
  ::close(descriptor);
  bytes.resize(done);
  return bytes;
}

}  // namespace mmm_converter
