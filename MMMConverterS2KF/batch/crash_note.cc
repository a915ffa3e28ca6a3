// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/crash_note.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <tuple>
#include <utility>

namespace mmm_converter {

// Handlers allocate nothing, and call only what may be called there.
struct CrashNote::Text {
  std::string file;
  // Before and after how the process ended: of the journal, and of what is printed.
  std::string line_begin, line_end, message_begin, message_end;
};

namespace {

constexpr std::array kSignals = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
constexpr std::size_t kMostThreads = 1024;
constexpr const char* kEnding = "<ENDING>";  // stands for how the process ended

std::array<struct sigaction, kSignals.size()> old_actions;

}  // namespace

// Visible to handlers. Texts live until what is here of them is gone.
struct CrashNotes {
  static inline std::array<std::atomic<const CrashNote::Text*>, kMostThreads> all{};
  static inline thread_local std::size_t own = kMostThreads;
  static inline std::atomic<bool> is_watched = false;

  static void Print(int file, const std::string& begin, const char* ending,
                    const std::string& end) {
    const std::array<iovec, 3> parts = {iovec{const_cast<char*>(begin.data()), begin.size()},
                                        iovec{const_cast<char*>(ending), std::strlen(ending)},
                                        iovec{const_cast<char*>(end.data()), end.size()}};
    [[maybe_unused]] const ssize_t written = ::writev(file, parts.data(), parts.size());
  }

  static void Write(const CrashNote::Text* text, const char* ending) {
    if (text == nullptr) return;
    const int file =
        ::open(text->file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (file < 0) return;
    Print(file, text->line_begin, ending, text->line_end);
    ::fsync(file);
    ::close(file);
    Print(STDERR_FILENO, text->message_begin, ending, text->message_end);
  }

  // Of this thread's entry; where it converts none, of all that run: it may be any of them.
  static bool WriteAll(const char* ending) {
    if (!is_watched) return false;
    if (own < kMostThreads) {
      Write(all[own], ending);
      return true;
    }
    bool has_any = false;
    for (const auto& text : all) {
      Write(text, ending);
      has_any = has_any || text != nullptr;
    }
    return has_any;
  }

  static void OnSignal(int signal) {
    const char* name = "a signal";
    if (signal == SIGSEGV) name = "segmentation fault";
    if (signal == SIGBUS) name = "bus error";
    if (signal == SIGFPE) name = "arithmetic error";
    if (signal == SIGILL) name = "illegal instruction";
    if (signal == SIGABRT) name = "it was aborted";
    WriteAll(name);
    std::signal(signal, SIG_DFL);
    ::raise(signal);  // comes when the handler has returned
  }

  static void OnExit() {
    if (WriteAll("exit() was called")) std::_Exit(EXIT_FAILURE);
  }

  // exit() first destroys what is local to its thread, then static objects: those that other
  // threads go on using are there until the process ends here.
  struct EndOfThread {
    ~EndOfThread() {
      if (own < kMostThreads) OnExit();
    }
  };
  static inline thread_local EndOfThread end_of_thread;
};

namespace {

std::pair<std::string, std::string> Split(const std::string& text) {
  const std::size_t at = text.rfind(kEnding);
  return {text.substr(0, at), text.substr(at + std::strlen(kEnding))};
}

}  // namespace

CrashNote::CrashNote(const std::string& folder, int shard, int shards, const JournalRecord& running)
    : file_(JournalFile(folder, shard, shards, ".crashed")) {
  stack_t stack{};  // that of a thread may be what is at its end
  stack.ss_sp = stack_.data();
  stack.ss_size = stack_.size();
  ::sigaltstack(&stack, &old_stack_);
  Update(running);
}

CrashNote::~CrashNote() {
  if (CrashNotes::own < kMostThreads) CrashNotes::all[CrashNotes::own] = nullptr;
  CrashNotes::own = kMostThreads;
  ::sigaltstack(&old_stack_, nullptr);
}

void CrashNote::Update(JournalRecord running) {
  running.crashed = true;
  running.result = Failed(std::string("the process ended while it ran: ") + kEnding, 0);
  auto text = std::make_unique<Text>();
  text->file = file_;
  [[maybe_unused]] const auto* watched = &CrashNotes::end_of_thread;  // made in this thread
  std::tie(text->line_begin, text->line_end) = Split(FormatJournalLine(running) + "\n");
  std::tie(text->message_begin, text->message_end) = Split(
      fmt::format("\nerror: {}: the process ended while it ran: {}; --resume goes on after it\n",
                  running.id, kEnding));
  if (CrashNotes::own < kMostThreads) {
    CrashNotes::all[CrashNotes::own] = text.get();
  } else {
    for (std::size_t i = 0; i < kMostThreads && CrashNotes::own == kMostThreads; ++i) {
      const Text* none = nullptr;
      if (CrashNotes::all[i].compare_exchange_strong(none, text.get())) CrashNotes::own = i;
    }
  }
  text_ = std::move(text);
}

CrashWatch::CrashWatch() {
  [[maybe_unused]] static const int registered = std::atexit(CrashNotes::OnExit);
  CrashNotes::is_watched = true;
  struct sigaction action {};
  action.sa_handler = CrashNotes::OnSignal;
  action.sa_flags = SA_ONSTACK;
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    ::sigaction(kSignals[i], &action, &old_actions[i]);
  }
}

CrashWatch::~CrashWatch() {
  CrashNotes::is_watched = false;
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    ::sigaction(kSignals[i], &old_actions[i], nullptr);
  }
}

}  // namespace mmm_converter
