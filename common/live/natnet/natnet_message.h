// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace mmm_converter {

// NatNet messages, a datagram each, little endian: u16 id, u16 bytes of the payload, payload.

enum class NatNetId : std::uint16_t {
  kConnect = 0,
  kServerInfo = 1,
  kRequest = 2,
  kResponse = 3,
  kRequestModel = 4,
  kModel = 5,
  kRequestFrame = 6,
  kFrame = 7,
  kText = 8,
  kDisconnect = 9,
  kKeepAlive = 10,
  kDisconnectByTimeout = 11,
  kEchoRequest = 12,
  kEchoResponse = 13,
  kDiscovery = 14,
  kUnrecognized = 100,
};

/// Of the stream: which layout its messages have.
struct NatNetVersion {
  int major = 0;
  int minor = 0;

  bool operator==(const NatNetVersion&) const = default;
  bool operator<(const NatNetVersion& other) const {
    return major != other.major ? major < other.major : minor < other.minor;
  }
  bool operator>(const NatNetVersion& other) const { return other < *this; }
  bool operator<=(const NatNetVersion& other) const { return !(other < *this); }
  bool operator>=(const NatNetVersion& other) const { return !(*this < other); }
};

inline constexpr NatNetVersion kOldestNatNet{2, 5};
inline constexpr NatNetVersion kNewestNatNet{4, 2};

/// "3.0"
std::string Format(const NatNetVersion& version);
/// @throws Error where the text is no version that is spoken here.
NatNetVersion ParseNatNetVersion(const std::string& text);

inline constexpr int kNatNetCommandPort = 1510;
inline constexpr int kNatNetDataPort = 1511;
inline constexpr const char* kNatNetGroup = "239.255.42.99";
inline constexpr std::size_t kMostNatNetBytes = 65507;  ///< of a datagram

struct NatNetMessage {
  NatNetId id = NatNetId::kConnect;
  std::string_view payload;
};

/// A datagram. Its own length counts, not the one that it states.
/// @throws BrokenMessage
NatNetMessage ParseNatNetMessage(std::string_view datagram);

std::string FormatNatNetMessage(NatNetId id, std::string_view payload);

/// Who sends: of server info, connect and discovery messages.
struct NatNetServerInfo {
  std::string application;  ///< "Motive"
  std::array<std::uint8_t, 4> application_version = {};
  NatNetVersion version;
  // From 3.0 on:
  std::uint64_t clock_rate = 0;  ///< [Hz] of the ticks in frames
  std::uint16_t data_port = kNatNetDataPort;
  bool is_multicast = false;
  std::string group = kNatNetGroup;
};

/// Payloads. @throws BrokenMessage
NatNetServerInfo ParseNatNetServerInfo(std::string_view payload);
std::string FormatNatNetServerInfo(const NatNetServerInfo& info);

/// The payload of connect and discovery messages: application and versions, and (4.x) the version
/// that the stream is wished in.
std::string FormatNatNetConnect(const std::string& application, const NatNetVersion& version);

}  // namespace mmm_converter
