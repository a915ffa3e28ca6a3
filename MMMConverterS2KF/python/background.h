// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <future>
#include <utility>

#include "common/support/error.h"
#include "common/support/opened_files.h"

namespace mmm_converter::python {

/// Says how far the work is: done, all. Returns false where it is to end.
using Progress = std::function<bool(int, int)>;

/// Computes work(progress) in a thread of its own while this one, without the interpreter's lock,
/// looks for Ctrl-C and calls `callback` with (done, all), which may be None. What either raises
/// ends the work. A result's `opened` becomes the files that it was made of (OpenedFiles).
template <typename Work>
auto InBackground(const pybind11::object& callback, Work work) {
  std::atomic<bool> is_cancelled = false;
  std::atomic<long> state = 0;  // done and all, as one
  const Progress progress = [&](int done, int all) {
    state = static_cast<long>(done) << 32 | all;
    return !is_cancelled;
  };
  std::exception_ptr raised;
  std::future<decltype(work(progress))> result;
  {
    const pybind11::gil_scoped_release release;
    result = std::async(std::launch::async, [&] {
      const OpenedFiles opened;
      auto made = work(progress);
      if constexpr (requires { made.opened; }) made.opened = opened.files();
      return made;
    });
    long shown = 0;
    bool is_ready = false;
    while (!is_ready) {
      is_ready = result.wait_for(std::chrono::milliseconds(50)) == std::future_status::ready;
      const long now = state;
      const pybind11::gil_scoped_acquire acquire;
      try {
        if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
        if (now != shown && !callback.is_none()) callback(now >> 32, now & 0x7fffffff);
        shown = now;
      } catch (...) {
        raised = std::current_exception();
        is_cancelled = true;
        break;
      }
    }
    result.wait();
  }
  if (raised) std::rethrow_exception(raised);
  return result.get();
}

/// For progress that can't end the work by what it returns.
inline std::function<void(int, int)> OrThrow(const Progress& progress) {
  return [progress](int done, int all) {
    if (!progress(done, all)) throw Error("ended before it was done");
  };
}

}  // namespace mmm_converter::python
