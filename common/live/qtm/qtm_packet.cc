// SPDX-License-Identifier: MIT
#include "common/live/qtm/qtm_packet.h"

#include <fmt/format.h>

#include "common/live/wire/byte_reader.h"
#include "common/live/wire/byte_writer.h"

namespace mmm_converter {
namespace {

// Ports within discovery packets are big endian, other than all else.
void AppendPort(std::uint16_t port, std::string* out) {
  out->push_back(static_cast<char>(port >> 8));
  out->push_back(static_cast<char>(port & 0xFF));
}

std::uint16_t TakePort(ByteReader* reader) {
  const auto high = reader->Take<std::uint8_t>();
  const auto low = reader->Take<std::uint8_t>();
  return static_cast<std::uint16_t>(high << 8 | low);
}

}  // namespace

std::size_t QtmPacketSize(std::string_view bytes) {
  if (bytes.size() < sizeof(std::uint32_t)) return 0;
  const auto size = ByteReader(bytes).Take<std::uint32_t>();
  if (size < kQtmHeaderBytes || size > kMostQtmBytes) {
    throw BrokenMessage(fmt::format("byte 0: a packet of {} bytes; it must have {} to {}", size,
                                    kQtmHeaderBytes, kMostQtmBytes));
  }
  return size;
}

QtmPacket ParseQtmPacket(std::string_view bytes) {
  ByteReader reader(bytes);
  const auto size = reader.Take<std::uint32_t>();
  const auto type = reader.Take<std::uint32_t>();
  if (size != bytes.size()) {
    throw BrokenMessage(
        fmt::format("byte 0: a packet of {} bytes, of which there are {}", size, bytes.size()));
  }
  if (type > static_cast<std::uint32_t>(QtmPacketType::kQtmFile)) {
    throw BrokenMessage(fmt::format("byte 4: a packet of the unknown type {}", type));
  }
  return {static_cast<QtmPacketType>(type), bytes.substr(kQtmHeaderBytes)};
}

std::string_view QtmText(const QtmPacket& packet) {
  return packet.body.substr(0, packet.body.find('\0'));
}

QtmEvent ParseQtmEvent(const QtmPacket& packet) {
  ByteReader reader(packet.body);
  const auto event = reader.Take<std::uint8_t>();
  reader.ExpectEnd();
  return static_cast<QtmEvent>(event);
}

void AppendQtmPacket(QtmPacketType type, std::string_view body, std::string* out) {
  ByteWriter writer(out);
  writer.PutCount(kQtmHeaderBytes + body.size());
  writer.Put(static_cast<std::uint32_t>(type));
  writer.PutBytes(body);
}

void AppendQtmText(QtmPacketType type, std::string_view text, std::string* out) {
  ByteWriter writer(out);
  writer.PutCount(kQtmHeaderBytes + text.size() + 1);
  writer.Put(static_cast<std::uint32_t>(type));
  writer.PutBytes(text);
  writer.Put('\0');
}

void AppendQtmEvent(QtmEvent event, std::string* out) {
  const char code = static_cast<char>(event);
  AppendQtmPacket(QtmPacketType::kEvent, {&code, 1}, out);
}

std::string FormatQtmDiscovery(std::uint16_t answer_port) {
  std::string port, packet;
  AppendPort(answer_port, &port);
  AppendQtmPacket(QtmPacketType::kDiscover, port, &packet);
  return packet;
}

std::uint16_t ParseQtmDiscovery(std::string_view bytes) {
  const QtmPacket packet = ParseQtmPacket(bytes);
  if (packet.type != QtmPacketType::kDiscover)
    throw BrokenMessage("byte 4: not a discovery packet");
  ByteReader reader(packet.body);
  const std::uint16_t port = TakePort(&reader);
  reader.ExpectEnd();
  return port;
}

std::string FormatQtmAnnouncement(const QtmAnnouncement& announcement) {
  std::string body = announcement.text + '\0';
  AppendPort(announcement.base_port, &body);
  std::string packet;
  AppendQtmPacket(QtmPacketType::kCommand, body, &packet);
  return packet;
}

QtmAnnouncement ParseQtmAnnouncement(std::string_view bytes) {
  const QtmPacket packet = ParseQtmPacket(bytes);
  if (packet.type != QtmPacketType::kCommand)
    throw BrokenMessage("byte 4: not an answer to a discovery");
  ByteReader reader(packet.body);
  QtmAnnouncement announcement;
  announcement.text = reader.TakeText();
  announcement.base_port = TakePort(&reader);
  reader.ExpectEnd();
  return announcement;
}

}  // namespace mmm_converter
