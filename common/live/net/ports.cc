// SPDX-License-Identifier: MIT
#include "common/live/net/ports.h"

#include <fmt/format.h>

#include <limits>

#include "common/support/error.h"

namespace mmm_converter {

std::uint16_t ToPort(int port) {
  if (port < 0 || port > std::numeric_limits<std::uint16_t>::max()) {
    throw Error(fmt::format("{} is no port; ports are 0 to 65535", port));
  }
  return static_cast<std::uint16_t>(port);
}

void FailToServe(const std::string& address, int port, const std::string& reason) {
  throw Error(fmt::format(
      "{}:{} can't be served: {}; end the program that has it, or choose another port or an "
      "address of this computer",
      address, port, reason));
}

}  // namespace mmm_converter
