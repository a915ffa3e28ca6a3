// SPDX-License-Identifier: MIT
#include "common/live/net/wait.h"

#include <poll.h>

#include <algorithm>
#include <vector>

namespace mmm_converter {

void WaitForSockets(std::span<const WaitFor> sockets, std::chrono::milliseconds most) {
  thread_local std::vector<pollfd> polled;
  polled.clear();
  for (const WaitFor& socket : sockets) {
    const short events = socket.to_write ? POLLIN | POLLOUT : POLLIN;
    if (socket.handle >= 0) polled.push_back({socket.handle, events, 0});
  }
  constexpr std::chrono::milliseconds kLongest{3600 * 1000};
  const auto wait = std::clamp(most, std::chrono::milliseconds(0), kLongest);
  ::poll(polled.data(), polled.size(), static_cast<int>(wait.count()));
}

}  // namespace mmm_converter
