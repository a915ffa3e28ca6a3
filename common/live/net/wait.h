// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <span>

namespace mmm_converter {

/// A socket that is waited for.
struct WaitFor {
  int handle = -1;        ///< -1: none
  bool to_write = false;  ///< until it takes bytes, too; else until it has some
};

/// Until one of the sockets is ready, or a signal comes, at most so long. Sockets that fail are
/// ready.
void WaitForSockets(std::span<const WaitFor> sockets, std::chrono::nanoseconds most);

}  // namespace mmm_converter
