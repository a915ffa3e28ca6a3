// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/terminal/interruption.h"

#include <array>
#include <csignal>

namespace mmm_converter {
namespace {

constexpr std::array kSignals = {SIGINT, SIGTERM, SIGHUP};

volatile std::sig_atomic_t noted_signal = 0;
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
