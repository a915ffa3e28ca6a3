// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace mmm_converter {

// Packets of QTM's real-time protocol, little endian: u32 size with this header, u32 type, body.

enum class QtmPacketType : std::uint32_t {
  kError = 0,
  kCommand = 1,
  kXml = 2,
  kData = 3,
  kNoMoreData = 4,
  kC3dFile = 5,
  kEvent = 6,
  kDiscover = 7,
  kQtmFile = 8,
};

enum class QtmEvent : std::uint8_t {
  kConnected = 1,
  kConnectionClosed = 2,
  kCaptureStarted = 3,
  kCaptureStopped = 4,
  kCalibrationStarted = 6,
  kCalibrationStopped = 7,
  kRtFromFileStarted = 8,
  kRtFromFileStopped = 9,
  kWaitingForTrigger = 10,
  kCameraSettingsChanged = 11,
  kShuttingDown = 12,
};

inline constexpr std::size_t kQtmHeaderBytes = 8;
/// Of a packet; what is larger is refused. Parameters of some thousand markers have room.
inline constexpr std::size_t kMostQtmBytes = std::size_t{2} << 20;

/// The minor numbers of the versions 1.x that are spoken here: their 3D data are the same.
inline constexpr int kOldestQtmMinor = 8;
inline constexpr int kNewestQtmMinor = 28;

struct QtmPacket {
  QtmPacketType type = QtmPacketType::kError;
  std::string_view body;  ///< without the header
};

/// What the packet at the start of `bytes` says to be its size [bytes]; 0: not yet known.
/// @throws BrokenMessage where no packet has this size.
std::size_t QtmPacketSize(std::string_view bytes);

/// A whole packet, nothing more. The body is a part of `bytes`.
/// @throws BrokenMessage
QtmPacket ParseQtmPacket(std::string_view bytes);

/// The body of an error, a command or XML, up to its NUL if it has one.
std::string_view QtmText(const QtmPacket& packet);

/// @throws BrokenMessage where the body is not one byte.
QtmEvent ParseQtmEvent(const QtmPacket& packet);

void AppendQtmPacket(QtmPacketType type, std::string_view body, std::string* out);
/// With a NUL at its end.
void AppendQtmText(QtmPacketType type, std::string_view text, std::string* out);
void AppendQtmEvent(QtmEvent event, std::string* out);

// Discovery, by UDP.

inline constexpr int kQtmDiscoveryPort = 22226;

/// answer_port: where the answers are awaited.
std::string FormatQtmDiscovery(std::uint16_t answer_port);
/// The port of FormatQtmDiscovery. @throws BrokenMessage
std::uint16_t ParseQtmDiscovery(std::string_view bytes);

struct QtmAnnouncement {
  std::string text;  ///< "HOST, QTM 2.5 (build 568), 5 cameras"
  std::uint16_t base_port = 0;
};

std::string FormatQtmAnnouncement(const QtmAnnouncement& announcement);
/// @throws BrokenMessage
QtmAnnouncement ParseQtmAnnouncement(std::string_view bytes);

}  // namespace mmm_converter
