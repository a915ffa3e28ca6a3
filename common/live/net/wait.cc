// SPDX-License-Identifier: MIT
#include "common/live/net/wait.h"

#include <poll.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace mmm_converter {

void WaitForSockets(std::span<const WaitFor> sockets, std::chrono::nanoseconds most) {
  thread_local std::vector<pollfd> polled;
  polled.clear();
  for (const WaitFor& socket : sockets) {
    const short events = socket.to_write ? POLLIN | POLLOUT : POLLIN;
    if (socket.handle >= 0) polled.push_back({socket.handle, events, 0});
  }
  constexpr std::int64_t kSecond = 1'000'000'000;
  const std::int64_t wait = std::clamp<std::int64_t>(most.count(), 0, 3600 * kSecond);
  const timespec time{wait / kSecond, wait % kSecond};
  ::ppoll(polled.data(), polled.size(), &time, nullptr);
}

}  // namespace mmm_converter
