// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/terminal/interruption.h"

#include <array>
#include <atomic>
#include <csignal>

namespace mmm_converter {
namespace {

constexpr std::array kSignals = {SIGINT, SIGTERM, SIGHUP};

std::atomic<int> noted_signal = 0;  // threads read what a handler wrote in another one
static_assert(std::atomic<int>::is_always_lock_free);
std::array<struct sigaction, kSignals.size()> old_actions;

void Note(int signal) { noted_signal = signal; }

}  // namespace

InterruptionWatch::InterruptionWatch() {
  noted_signal = 0;
  struct sigaction action {};
  action.sa_handler = Note;
  action.sa_flags = SA_RESTART | SA_RESETHAND;
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    sigaction(kSignals[i], nullptr, &old_actions[i]);
    // nohup and shells in the background have them ignored.
    if (old_actions[i].sa_handler != SIG_IGN) sigaction(kSignals[i], &action, nullptr);
  }
}

InterruptionWatch::~InterruptionWatch() {
  for (std::size_t i = 0; i < kSignals.size(); ++i)
    sigaction(kSignals[i], &old_actions[i], nullptr);
}

int InterruptionWatch::Signal() { return noted_signal; }

}  // namespace mmm_converter
