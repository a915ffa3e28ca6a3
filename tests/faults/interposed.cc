// SPDX-License-Identifier: MIT
// Loaded before a program (LD_PRELOAD), it makes one of its calls fail, kills it there, or moves
// its clock, as MMM_FAULT says, and writes what was called to the file MMM_FAULT_REPORT.

#include <dlfcn.h>
#include <fcntl.h>
#include <malloc.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>

// NOLINTBEGIN(bugprone-reserved-identifier): names of the C library
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* memory);
}
// NOLINTEND(bugprone-reserved-identifier)

namespace {

/// Calls of one kind, of which one or more fail.
struct Calls {
  std::atomic<long> count = 0;
  long first_fault = 0;  // from 1; 0: none
  bool all_later = false;

  bool Fails() {
    const long number = ++count;
    return first_fault > 0 && (all_later ? number >= first_fault : number == first_fault);
  }
};

Calls allocations, reads, changes;
int error_number = EIO;
bool kills = false;
long clock_step = 0;  // [s]
bool clock_is_wrong_always = false;
std::atomic<bool> has_begun = false;
std::atomic<long> live_bytes = 0, peak_bytes = 0, clock_calls = 0;

/// "alloc:N", "read:N", "change:N[:ERRNO]", "kill:N"; with + before the colon the later ones too;
/// "clock:SECONDS" for each second call, "clock+:SECONDS" for all.
void ReadFault() {
  const char* const fault = std::getenv("MMM_FAULT");
  if (fault == nullptr) return;
  const char* const colon = std::strchr(fault, ':');
  if (colon == nullptr) return;
  const auto is = [fault](const char* name) {
    return std::strncmp(fault, name, std::strlen(name)) == 0;
  };
  char* end = nullptr;
  const long number = std::strtol(colon + 1, &end, 10);
  if (is("clock")) {
    clock_step = number;
    clock_is_wrong_always = colon[-1] == '+';
    return;
  }
  kills = is("kill");
  Calls& calls = is("alloc") ? allocations : is("read") ? reads : changes;
  calls.all_later = colon[-1] == '+';
  calls.first_fault = number;
  if (*end == ':') error_number = static_cast<int>(std::strtol(end + 1, nullptr, 10));
}

__attribute__((constructor)) void Begin() { ReadFault(); }

__attribute__((destructor)) void Report() {
  const char* const file = std::getenv("MMM_FAULT_REPORT");
  if (file == nullptr) return;
  char text[200];
  const int size = std::snprintf(text, sizeof(text), "alloc %ld\nread %ld\nchange %ld\npeak %ld\n",
                                 allocations.count.load(), reads.count.load(), changes.count.load(),
                                 peak_bytes.load());
  const long descriptor = syscall(SYS_openat, AT_FDCWD, file, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  syscall(SYS_write, descriptor, text, size);
  syscall(SYS_close, descriptor);
}

void* Taken(void* memory) {
  const long size = static_cast<long>(malloc_usable_size(memory));
  const long live = live_bytes += size;
  long peak = peak_bytes;
  while (live > peak && !peak_bytes.compare_exchange_weak(peak, live)) {
  }
  return memory;
}

bool AllocationFails() {
  if (!has_begun || !allocations.Fails()) return false;
  errno = ENOMEM;
  return true;
}

bool ReadFails() {
  if (!reads.Fails()) return false;
  errno = error_number;
  return true;
}

/// Of a call that changes files.
bool ChangeFails() {
  if (!changes.Fails()) return false;
  if (kills) std::raise(SIGKILL);
  errno = error_number;
  return true;
}

bool IsTerminal(int descriptor) { return descriptor <= STDERR_FILENO; }

int Open(int folder, const char* path, int flags, mode_t mode) {
  if ((flags & O_ACCMODE) != O_RDONLY && ChangeFails()) return -1;
  return static_cast<int>(syscall(SYS_openat, folder, path, flags, mode));
}

mode_t ModeOf(int flags, va_list more) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, mode_t) : 0;
}

template <typename Function>
Function Next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

void* malloc(std::size_t size) { return AllocationFails() ? nullptr : Taken(__libc_malloc(size)); }
void* calloc(std::size_t count, std::size_t size) {
  return AllocationFails() ? nullptr : Taken(__libc_calloc(count, size));
}
void* realloc(void* old, std::size_t size) {
  if (AllocationFails()) return nullptr;
  live_bytes -= static_cast<long>(malloc_usable_size(old));
  return Taken(__libc_realloc(old, size));
}
void* memalign(std::size_t alignment, std::size_t size) {
  return AllocationFails() ? nullptr : Taken(__libc_memalign(alignment, size));
}
void* aligned_alloc(std::size_t alignment, std::size_t size) { return memalign(alignment, size); }
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  void* const taken = memalign(alignment, size);
  if (taken == nullptr) return ENOMEM;
  *memory = taken;
  return 0;
}
void free(void* memory) {
  live_bytes -= static_cast<long>(malloc_usable_size(memory));
  __libc_free(memory);
}

ssize_t read(int descriptor, void* bytes, std::size_t size) {
  return ReadFails() ? -1 : syscall(SYS_read, descriptor, bytes, size);
}
ssize_t pread(int descriptor, void* bytes, std::size_t size, off_t offset) {
  return ReadFails() ? -1 : syscall(SYS_pread64, descriptor, bytes, size, offset);
}
ssize_t pread64(int descriptor, void* bytes, std::size_t size, off64_t offset) {
  return pread(descriptor, bytes, size, offset);
}
std::size_t fread(void* bytes, std::size_t size, std::size_t count, FILE* file) {
  static const auto next = Next<decltype(&fread)>("fread");
  return ReadFails() ? 0 : next(bytes, size, count, file);
}

int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = ModeOf(flags, more);
  va_end(more);
  return Open(AT_FDCWD, path, flags, mode);
}
int open64(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = ModeOf(flags, more);
  va_end(more);
  return Open(AT_FDCWD, path, flags, mode);
}
ssize_t write(int descriptor, const void* bytes, std::size_t size) {
  if (!IsTerminal(descriptor) && ChangeFails()) return -1;
  return syscall(SYS_write, descriptor, bytes, size);
}
ssize_t pwrite(int descriptor, const void* bytes, std::size_t size, off_t offset) {
  return ChangeFails() ? -1 : syscall(SYS_pwrite64, descriptor, bytes, size, offset);
}
ssize_t pwrite64(int descriptor, const void* bytes, std::size_t size, off64_t offset) {
  return pwrite(descriptor, bytes, size, offset);
}
int rename(const char* from, const char* to) {
  return ChangeFails() ? -1 : static_cast<int>(syscall(SYS_rename, from, to));
}
int unlink(const char* path) {
  return ChangeFails() ? -1 : static_cast<int>(syscall(SYS_unlink, path));
}
int linkat(int from_folder, const char* from, int to_folder, const char* to, int flags) {
  return ChangeFails()
             ? -1
             : static_cast<int>(syscall(SYS_linkat, from_folder, from, to_folder, to, flags));
}
int mkdir(const char* path, mode_t mode) {
  return ChangeFails() ? -1 : static_cast<int>(syscall(SYS_mkdir, path, mode));
}
int fchmod(int descriptor, mode_t mode) {
  return ChangeFails() ? -1 : static_cast<int>(syscall(SYS_fchmod, descriptor, mode));
}
int fdatasync(int descriptor) {
  return ChangeFails() ? -1 : static_cast<int>(syscall(SYS_fdatasync, descriptor));
}
int ftruncate(int descriptor, off_t size) {
  return ChangeFails() ? -1 : static_cast<int>(syscall(SYS_ftruncate, descriptor, size));
}
int ftruncate64(int descriptor, off64_t size) { return ftruncate(descriptor, size); }

// The program's first call: what the libraries allocate before is not its own.
sighandler_t signal(int number, sighandler_t handler) {
  static const auto next = Next<decltype(&signal)>("signal");
  has_begun = true;
  return next(number, handler);
}

int clock_gettime(clockid_t clock, timespec* time) {
  const auto result = static_cast<int>(syscall(SYS_clock_gettime, clock, time));
  if (clock == CLOCK_REALTIME && (clock_is_wrong_always || clock_calls++ % 2 != 0)) {
    time->tv_sec += clock_step;
  }
  return result;
}
}
