// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

namespace mmm_converter {

/// Bytes that are received at a time.
inline constexpr std::size_t kReceivedAtOnce = 1 << 16;

/// A port number. @throws Error where there is no such port.
std::uint16_t ToPort(int port);

/// @throws Error saying that the port can't be served.
[[noreturn]] void FailToServe(const std::string& address, int port, const std::string& reason);

}  // namespace mmm_converter
