// SPDX-License-Identifier: MIT
#pragma once

namespace mmm_converter {

/// From its construction on SIGINT, SIGTERM and SIGHUP are noted instead of ending the process; a
/// second one ends it. One at a time.
class InterruptionWatch {
 public:
  InterruptionWatch();
  ~InterruptionWatch();  ///< signals do again what they did before
  InterruptionWatch(const InterruptionWatch&) = delete;
  InterruptionWatch& operator=(const InterruptionWatch&) = delete;

  static int Signal();  ///< that came; 0: none
};

}  // namespace mmm_converter
