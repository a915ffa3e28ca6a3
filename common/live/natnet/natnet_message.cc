// SPDX-License-Identifier: MIT
#include "common/live/natnet/natnet_message.h"

#include <fmt/format.h>

#include "common/live/wire/byte_reader.h"
#include "common/live/wire/byte_writer.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kNameBytes = 256;
constexpr NatNetVersion kFirstWithClock{3, 0};

void PutVersion(const NatNetVersion& version, ByteWriter* writer) {
  writer->Put(static_cast<std::uint8_t>(version.major));
  writer->Put(static_cast<std::uint8_t>(version.minor));
  writer->Put(std::uint16_t{0});
}

std::array<std::uint8_t, 4> ParseGroup(const std::string& text) {
  std::array<std::uint8_t, 4> group = {};
  std::size_t at = 0;
  for (std::uint8_t& part : group) {
    const std::size_t end = text.find('.', at);
    const auto number = ParseLong(text.substr(at, end - at));
    if (!number || *number < 0 || *number > 255) {
      throw Error(fmt::format("\"{}\" is no IPv4 address such as {}", text, kNatNetGroup));
    }
    part = static_cast<std::uint8_t>(*number);
    at = end == std::string::npos ? text.size() : end + 1;
  }
  return group;
}

}  // namespace

std::string Format(const NatNetVersion& version) {
  return fmt::format("{}.{}", version.major, version.minor);
}

NatNetVersion ParseNatNetVersion(const std::string& text) {
  const std::size_t point = text.find('.');
  const auto major = ParseLong(text.substr(0, point));
  const auto minor =
      point == std::string::npos ? std::optional<long>(0) : ParseLong(text.substr(point + 1));
  if (major && minor && *major >= 0 && *major < 100 && *minor >= 0 && *minor < 100) {
    const NatNetVersion version{static_cast<int>(*major), static_cast<int>(*minor)};
    if (version >= kOldestNatNet && version <= kNewestNatNet) return version;
  }
  throw Error(fmt::format("\"{}\" is no version of NatNet that is known here; use {} to {}", text,
                          Format(kOldestNatNet), Format(kNewestNatNet)));
}

NatNetMessage ParseNatNetMessage(std::string_view datagram) {
  ByteReader reader(datagram);
  NatNetMessage message;
  message.id = static_cast<NatNetId>(reader.Take<std::uint16_t>());
  reader.Take<std::uint16_t>();
  message.payload = datagram.substr(reader.at());
  return message;
}

std::string FormatNatNetMessage(NatNetId id, std::string_view payload) {
  std::string message;
  ByteWriter writer(&message);
  writer.Put(static_cast<std::uint16_t>(id));
  writer.Put(static_cast<std::uint16_t>(payload.size()));
  writer.PutBytes(payload);
  return message;
}

NatNetServerInfo ParseNatNetServerInfo(std::string_view payload) {
  ByteReader reader(payload);
  NatNetServerInfo info;
  const std::string_view name = reader.TakeBytes(kNameBytes);
  info.application = ToUtf8(name.substr(0, name.find('\0')));
  for (std::uint8_t& part : info.application_version) part = reader.Take<std::uint8_t>();
  info.version.major = reader.Take<std::uint8_t>();
  info.version.minor = reader.Take<std::uint8_t>();
  reader.TakeBytes(2);
  if (info.version < kFirstWithClock) return info;
  info.clock_rate = reader.Take<std::uint64_t>();
  info.data_port = reader.Take<std::uint16_t>();
  info.is_multicast = reader.Take<std::uint8_t>() != 0;
  std::uint8_t group[4];
  reader.TakeArray(group);
  info.group = fmt::format("{}.{}.{}.{}", group[0], group[1], group[2], group[3]);
  return info;
}

std::string FormatNatNetServerInfo(const NatNetServerInfo& info) {
  std::string payload;
  ByteWriter writer(&payload);
  writer.PutFixedText(info.application, kNameBytes);
  for (const std::uint8_t part : info.application_version) writer.Put(part);
  PutVersion(info.version, &writer);
  if (info.version < kFirstWithClock) return payload;
  writer.Put(info.clock_rate);
  writer.Put(info.data_port);
  writer.Put(static_cast<std::uint8_t>(info.is_multicast));
  for (const std::uint8_t part : ParseGroup(info.group)) writer.Put(part);
  return payload;
}

std::string FormatNatNetConnect(const std::string& application, const NatNetVersion& version) {
  std::string payload;
  ByteWriter writer(&payload);
  writer.PutFixedText(application, kNameBytes);
  PutVersion({0, 1}, &writer);
  PutVersion(version, &writer);
  writer.Put(std::uint8_t{0});  // all data, not only what is subscribed to
  PutVersion(version, &writer);
  writer.Put(std::uint8_t{0});
  return payload;
}

}  // namespace mmm_converter
