// SPDX-License-Identifier: MIT
// What QtmServer answers.
#include <fmt/format.h>

#include "common/live/qtm/qtm_server.h"
#include "common/live/wire/broken_message.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr const char* kParseError = "Parse error";

void Say(QtmPacketType type, std::string_view text, QtmConnection* connection) {
  AppendQtmText(type, text, connection->out());
}

std::vector<std::string> WithoutFirst(const std::vector<std::string>& words) {
  return {words.begin() + 1, words.end()};
}

/// What QTM can and this server, which only plays, can't.
bool IsOfQtmOnly(const std::string& command) {
  for (const char* name : {"new", "close", "start", "stop", "load", "save", "loadproject", "trig",
                           "setqtmevent", "event", "reprocess", "getcapturec3d", "getcaptureqtm",
                           "getcapture", "calibrate", "led", "takecontrol"}) {
    if (command == name) return true;
  }
  return false;
}

}  // namespace

void QtmServer::Answer(Session* session, std::string_view bytes) {
  QtmConnection& connection = session->connection;
  std::vector<std::string> words;
  try {
    const QtmPacket packet = ParseQtmPacket(bytes);
    if (packet.type != QtmPacketType::kCommand) {
      return Say(QtmPacketType::kError, "Only commands are understood", &connection);
    }
    words = SplitQtmCommand(QtmText(packet));
  } catch (const BrokenMessage&) {
    return connection.Close();
  }
  const std::string command = words.empty() ? "" : words.front();
  if (command == "version") {
    SetVersion(session, words);
  } else if (command == "qtmversion") {
    Say(QtmPacketType::kCommand, "QTM Version is 2.3 (build 0, MMMConverterS2KF)", &connection);
  } else if (command == "byteorder") {
    Say(QtmPacketType::kCommand, "Byte order is little endian", &connection);
  } else if (command == "checklicense") {
    Say(QtmPacketType::kCommand, "License pass", &connection);
  } else if (command == "releasecontrol") {
    Say(QtmPacketType::kCommand, "You are already a regular client", &connection);
  } else if (command == "getstate" || command == "getlastevent") {
    AppendQtmEvent(
        playback_.has_ended() ? QtmEvent::kRtFromFileStopped : QtmEvent::kRtFromFileStarted,
        connection.out());
  } else if (IsOfQtmOnly(command)) {
    Say(QtmPacketType::kError, "This server plays a recording and can not be controlled",
        &connection);
  } else {
    AnswerWithVersion(session, words);
  }
}

void QtmServer::AnswerWithVersion(Session* session, const std::vector<std::string>& words) {
  QtmConnection& connection = session->connection;
  const std::string command = words.empty() ? "" : words.front();
  const bool is_known =
      command == "getparameters" || command == "getcurrentframe" || command == "streamframes";
  if (!is_known) return Say(QtmPacketType::kError, kParseError, &connection);
  if (session->minor < 0) {
    return Say(QtmPacketType::kError,
               fmt::format("Set a version from 1.{} to 1.{} first", kOldestQtmMinor,
                           options_.newest_minor),
               &connection);
  }
  if (command == "getparameters") {
    SendParameters(session, WithoutFirst(words));
  } else if (command == "getcurrentframe") {
    SendCurrentFrame(session, WithoutFirst(words));
  } else {
    StartStream(session, WithoutFirst(words));
  }
}

void QtmServer::SetVersion(Session* session, const std::vector<std::string>& words) {
  QtmConnection& connection = session->connection;
  if (words.size() == 1) {
    return Say(QtmPacketType::kCommand,
               fmt::format("Version is 1.{}", session->minor < 0 ? 1 : session->minor),
               &connection);
  }
  const std::string& version = words[1];
  const auto minor = version.starts_with("1.") ? ParseLong(version.substr(2)) : std::nullopt;
  if (!minor || *minor < kOldestQtmMinor || *minor > options_.newest_minor) {
    return Say(QtmPacketType::kError, "Version NOT supported", &connection);
  }
  session->minor = static_cast<int>(*minor);
  Say(QtmPacketType::kCommand, fmt::format("Version set to 1.{}", session->minor), &connection);
}

void QtmServer::SendParameters(Session* session, const std::vector<std::string>& words) {
  const auto choice = ParseQtmParameterChoice(words);
  if (!choice) return Say(QtmPacketType::kError, kParseError, &session->connection);
  QtmParameters parameters;
  parameters.rate = recording_.rate();
  parameters.capture_time = recording_.num_frames() / recording_.rate();
  parameters.up_axis = options_.up_axis;
  parameters.calibration_time = "2000-01-01 00:00:00";
  parameters.labels = columns_.labels;
  AppendQtmText(QtmPacketType::kXml, FormatQtmParameters(parameters, *choice, session->minor),
                session->connection.out());
}

void QtmServer::SendCurrentFrame(Session* session, const std::vector<std::string>& words) {
  const auto components = ParseQtmComponents(words);
  if (!components) return Say(QtmPacketType::kError, kParseError, &session->connection);
  if (!playback_.has_ended()) Begin();
  // Where nobody streams, who asks takes the next frame of what is played as fast as possible.
  bool is_streamed = false;
  for (const auto& other : sessions_) is_streamed = is_streamed || other->is_streaming;
  if (!current_ || (options_.playback.speed == 0 && !is_streamed)) {
    if (const auto number = playback_.Take()) MakeData(*number);
  }
  if (!current_ || playback_.has_ended()) {
    return AppendQtmPacket(QtmPacketType::kNoMoreData, "", session->connection.out());
  }
  AppendQtmData(data_, *components, session->connection.out());
}

void QtmServer::StartStream(Session* session, const std::vector<std::string>& words) {
  auto wish = ParseQtmStreamRequest(words);
  if (!wish) return Say(QtmPacketType::kError, kParseError, &session->connection);
  session->is_streaming = false;
  if (wish->stop) return;
  session->udp = {};
  if (wish->udp_port != 0) {
    const std::string host =
        wish->udp_host.empty() ? session->connection.tcp().peer() : wish->udp_host;
    try {
      session->udp = FindUdpAddress(host, wish->udp_port);
    } catch (const Error&) {
      return Say(QtmPacketType::kError, kParseError, &session->connection);
    }
  }
  session->wish = std::move(*wish);
  session->is_streaming = true;
  Begin();
}

}  // namespace mmm_converter
