// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "common/live/net/wait.h"

namespace mmm_converter {

/// An IPv4 address with a port. 0: none.
struct UdpAddress {
  std::uint32_t ip = 0;
  std::uint16_t port = 0;
  bool operator==(const UdpAddress&) const = default;
};

/// The address of a host by its name or number. @throws Error
UdpAddress FindUdpAddress(const std::string& host, int port);
std::string FormatIp(const UdpAddress& address);  ///< "192.168.1.2"

/// A UDP socket (IPv4) that never waits.
class UdpSocket {
 public:
  /// address "": of all interfaces. port 0: any that is free. shared: others may have it too.
  /// @throws Error where it is taken, or the address is none of this computer.
  UdpSocket(const std::string& address, int port, bool shared = false);
  ~UdpSocket();
  UdpSocket(UdpSocket&&) noexcept;
  UdpSocket& operator=(UdpSocket&&) noexcept;

  int port() const;

  /// Receives what is sent to a multicast group at an interface, which is named by its address.
  /// @throws Error
  void Join(const std::string& group, const std::string& interface_address);
  /// Sends to multicast groups through this interface. @throws Error
  void SendThrough(const std::string& interface_address);
  void AllowBroadcast();

  /// false: the system does not take it.
  bool Send(std::string_view datagram, const UdpAddress& to);
  /// The next datagram, valid until the next call; nothing where there is none.
  std::optional<std::string_view> Receive(UdpAddress* from);
  WaitFor Waiting() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The address of this computer towards another. @throws Error
std::string LocalAddressTowards(const UdpAddress& other);

}  // namespace mmm_converter
