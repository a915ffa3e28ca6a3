// SPDX-License-Identifier: MIT
#include "common/support/atomic_file.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include "common/support/error.h"
#include "common/support/folder.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

// Names of the files that are not yet whole.
constexpr std::string_view kScratchBegin = ".mmm_converter.";
constexpr std::string_view kScratchEnd = ".tmp";

[[noreturn]] void Fail(const std::string& path, int error_number) {
  throw WriteError(path, error_number);
}

/// The file that a chain of symbolic links leads to, which need not exist.
fs::path FinalTarget(const std::string& path) {
  constexpr int kMostLinks = 40;  // as the kernel
  fs::path target = path;
  for (int i = 0; i < kMostLinks; ++i) {
    std::error_code error;
    const fs::path next = fs::read_symlink(target, error);
    if (error) return target;
    target = next.is_absolute() ? next : target.parent_path() / next;
  }
  Fail(path, ELOOP);
}

}  // namespace

/// An open file that is closed at the end of its scope, and removed unless it has been kept.
class ScratchFile {
 public:
  ScratchFile(int descriptor, std::string name) : descriptor_(descriptor), name_(std::move(name)) {}
  ~ScratchFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!name_.empty()) ::unlink(name_.c_str());
  }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  int descriptor() const { return descriptor_; }
  const std::string& name() const { return name_; }
  void SetName(std::string name) { name_ = std::move(name); }
  bool Close() { return ::close(std::exchange(descriptor_, -1)) == 0; }
  void Keep() { name_.clear(); }

 private:
  int descriptor_;
  std::string name_;  // empty: not removed
};

namespace {

/// Writes pieces to a file as they come.
class Output {
 public:
  Output(const std::string& path, int descriptor) : path_(path), descriptor_(descriptor) {}

  void Write(std::string_view content) {
    while (!content.empty()) {
      const ssize_t written = ::write(descriptor_, content.data(), content.size());
      if (written < 0 && errno != EINTR) Fail(path_, errno);
      if (written <= 0) continue;
      content.remove_prefix(static_cast<std::size_t>(written));
      written_ += written;
    }
    StartStoring();
  }

 private:
  /// Lets the disk work while the next pieces are made; that it could not is no failure.
  void StartStoring() {
    constexpr off_t kLeast = 8 << 20;
    if (written_ - storing_ < kLeast) return;
#ifdef SYNC_FILE_RANGE_WRITE
    ::sync_file_range(descriptor_, storing_, written_ - storing_, SYNC_FILE_RANGE_WRITE);
#endif
    storing_ = written_;
  }

  const std::string& path_;
  int descriptor_;
  off_t written_ = 0;
  off_t storing_ = 0;
};

/// Pipes that are open until they are written, by path.
std::map<std::string, int> held_pipes;
std::mutex held_pipes_mutex;

int OpenDirectly(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0 && errno == ENXIO) {
    throw Error(
        fmt::format("{}: can't be written: nobody reads this pipe; start its reader first", path));
  }
  if (descriptor < 0) Fail(path, errno);
  return descriptor;
}

int TakeHeldPipe(const std::string& path) {
  const std::scoped_lock lock(held_pipes_mutex);
  const auto held = held_pipes.find(path);
  if (held == held_pipes.end()) return -1;
  const int descriptor = held->second;
  held_pipes.erase(held);
  return descriptor;
}

void WriteDirectly(const std::string& path, const TextPieces& content) {
  const int held = TakeHeldPipe(path);
  ScratchFile file(held >= 0 ? held : OpenDirectly(path), "");
  ::fcntl(file.descriptor(), F_SETFL, O_WRONLY);  // a slow reader is waited for
  Output output(path, file.descriptor());
  content([&](std::string_view piece) { output.Write(piece); });
  if (!file.Close()) Fail(path, errno);
}

fs::path FolderOf(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

struct Created {
  int descriptor;
  std::string name;
};

/// Whether this process is now the one that has the file, which RemoveAbandonedFiles has not
/// removed meanwhile. Where files can't be locked, nobody removes them.
bool Take(int descriptor) {
  if (::flock(descriptor, LOCK_EX) != 0) return true;
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 && status.st_nlink > 0;
}

std::string ScratchName(const fs::path& folder, int number) {
  return folder / fmt::format("{}{}.{}{}", kScratchBegin, ::getpid(), number, kScratchEnd);
}

constexpr int kMostTries = 1000;

/// A new file in `folder` that has no name yet: of a process that is killed nothing is left. -1
/// where the file system or the machine has no such files.
int CreateNameless([[maybe_unused]] const fs::path& folder) {
#ifdef O_TMPFILE
  if (::access("/proc/self/fd", X_OK) != 0) return -1;
  const int descriptor = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
  if (descriptor >= 0) ::flock(descriptor, LOCK_EX);
  return descriptor;
#else
  return -1;
#endif
}

/// A name in `folder` that nothing else has for a nameless file; empty where that failed.
std::string GiveName(int descriptor, const fs::path& folder) {
  const std::string file = fmt::format("/proc/self/fd/{}", descriptor);
  for (int i = 0;; ++i) {
    std::string name = ScratchName(folder, i);
    if (::linkat(AT_FDCWD, file.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0) {
      return name;
    }
    if (errno != EEXIST || i == kMostTries) return {};
  }
}

/// A new file in `folder` under a name that nothing else has; descriptor -1 where that failed.
Created CreateIn(const fs::path& folder) {
  for (int i = 0;; ++i) {
    std::string name = ScratchName(folder, i);
    const int descriptor = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0 && !Take(descriptor)) {
      ::close(descriptor);
      continue;
    }
    if (descriptor >= 0 || errno != EEXIST || i == kMostTries) return {descriptor, std::move(name)};
  }
}

/// Removes a file unless the process that writes it is alive, which has it locked.
void RemoveIfAbandoned(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (descriptor < 0) return;
  if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) ::unlink(file.c_str());
  ::close(descriptor);
}

/// Removes what killed processes left in a folder, when this process first writes there.
void TidyOnce(const fs::path& folder) {
  static std::mutex mutex;
  static std::set<fs::path> tidied;
  const std::scoped_lock lock(mutex);
  if (tidied.insert(folder).second) RemoveAbandonedFiles(folder);
}

thread_local FilesTogether* together = nullptr;

}  // namespace

/// A file that is whole but has not yet its name.
class FilesTogether::Held {
 public:
  /// Of what is no regular file, which is written at the end.
  Held(std::string path, std::string content)
      : path_(std::move(path)), content_(std::move(content)), scratch_(-1, "") {}
  Held(std::string path, fs::path target, const Created& created)
      : path_(std::move(path)),
        target_(std::move(target)),
        scratch_(created.descriptor, created.name) {}

  void Name() {
    if (target_.empty()) {
      return WriteDirectly(path_, [this](const TextSink& sink) { sink(content_); });
    }
    if (scratch_.name().empty())
      scratch_.SetName(GiveName(scratch_.descriptor(), FolderOf(target_)));
    if (scratch_.name().empty() || !scratch_.Close() ||
        ::rename(scratch_.name().c_str(), target_.c_str()) != 0) {
      Fail(path_, errno);
    }
    scratch_.Keep();
  }

 private:
  std::string path_;
  std::string content_;
  fs::path target_;  // empty: is written directly
  ScratchFile scratch_;
};

FilesTogether::FilesTogether() : is_outermost_(together == nullptr) {
  if (is_outermost_) together = this;
}

FilesTogether::~FilesTogether() {
  if (is_outermost_) together = nullptr;
}

void FilesTogether::Commit() {
  for (const auto& one : held_) one->Name();
  held_.clear();
}

void HoldPipe(const std::string& path) {
  std::error_code failure;
  if (!fs::is_fifo(path, failure)) return;
  const std::scoped_lock lock(held_pipes_mutex);
  if (held_pipes.count(path) == 0) held_pipes[path] = OpenDirectly(path);
}

void WriteFileAtomically(const std::string& path, std::string_view content) {
  WriteFileAtomically(path, [content](const TextSink& sink) { sink(content); });
}

void WriteFileAtomically(const std::string& path, const TextPieces& content) {
  if (path.empty()) throw Error("the name of the file to write is empty");
  const fs::path target = FinalTarget(path);
  struct stat old {};
  const bool exists = ::stat(target.c_str(), &old) == 0;
  if (exists && S_ISDIR(old.st_mode)) {
    throw Error(fmt::format("{}: is a folder; give the name of a file", path));
  }
  if (exists && !S_ISREG(old.st_mode)) {
    if (together == nullptr) return WriteDirectly(path, content);
    together->held_.push_back(std::make_unique<FilesTogether::Held>(path, Join(content)));
    return;
  }
  if (exists && ::faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0) Fail(path, errno);

  const fs::path folder = FolderOf(target);
  TidyOnce(folder);
  const int nameless = CreateNameless(folder);
  const Created created = nameless >= 0 ? Created{nameless, ""} : CreateIn(folder);
  if (created.descriptor < 0 && errno == ENOENT) {
    throw Error(fmt::format("{}: can't be written: there is no folder {}", path, folder.string()));
  }
  if (created.descriptor < 0) Fail(path, errno);
  auto held = std::make_unique<FilesTogether::Held>(path, target, created);
  if (exists && ::fchmod(created.descriptor, old.st_mode & 07777) != 0) Fail(path, errno);
  Output output(path, created.descriptor);
  content([&](std::string_view piece) { output.Write(piece); });
  if (::fdatasync(created.descriptor) != 0) Fail(path, errno);
  if (together == nullptr) return held->Name();
  together->held_.push_back(std::move(held));
}

void RemoveAbandonedFiles(const std::string& folder) {
  for (const std::string& name : NamesIn(folder)) {
    if (name.starts_with(kScratchBegin) && name.ends_with(kScratchEnd)) {
      RemoveIfAbandoned(fs::path(folder) / name);
    }
  }
}

}  // namespace mmm_converter
