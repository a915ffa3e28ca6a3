// SPDX-License-Identifier: MIT
#include "common/live/mvn/mvn_packet.h"

#include <bit>

namespace mmm_converter {
namespace {

constexpr std::uint8_t kLastDatagram = 0x80;
constexpr int kItemBytes = 32;

void AddByte(std::uint8_t value, std::string* bytes) { *bytes += static_cast<char>(value); }

void AddShort(std::uint16_t value, std::string* bytes) {
  AddByte(static_cast<std::uint8_t>(value >> 8), bytes);
  AddByte(static_cast<std::uint8_t>(value), bytes);
}

void AddLong(std::uint32_t value, std::string* bytes) {
  AddShort(static_cast<std::uint16_t>(value >> 16), bytes);
  AddShort(static_cast<std::uint16_t>(value), bytes);
}

void AddFloat(double value, std::string* bytes) {
  AddLong(std::bit_cast<std::uint32_t>(static_cast<float>(value)), bytes);
}

}  // namespace

std::string FormatMvnPacket(std::uint32_t sample, std::uint32_t milliseconds,
                            const MvnPoses& poses) {
  std::string bytes = "MXTP02";
  bytes.reserve(24 + kMvnSegments * kItemBytes);
  AddLong(sample, &bytes);
  AddByte(kLastDatagram, &bytes);
  AddByte(kMvnSegments, &bytes);
  AddLong(milliseconds, &bytes);
  AddByte(0, &bytes);  // character
  AddByte(kMvnSegments, &bytes);
  AddByte(0, &bytes);  // props
  AddByte(0, &bytes);  // finger segments
  AddShort(0, &bytes);
  AddShort(kMvnSegments * kItemBytes, &bytes);
  for (int i = 0; i < kMvnSegments; ++i) {
    const Eigen::Vector3d& p = poses[static_cast<std::size_t>(i)].translation();
    const Eigen::Quaterniond q(poses[static_cast<std::size_t>(i)].linear());
    AddLong(static_cast<std::uint32_t>(i + 1), &bytes);
    for (const double value : {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()}) {
      AddFloat(value, &bytes);
    }
  }
  return bytes;
}

}  // namespace mmm_converter
