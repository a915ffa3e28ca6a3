// SPDX-License-Identifier: MIT
#include "common/live/qtm/qtm_server.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/support/error.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

// Bytes that wait for a client: beyond, a recording that is played as fast as possible waits for
// it, one that is played in time goes on without it, and who only asks is sent away.
constexpr std::size_t kHoldUpBytes = std::size_t{1} << 18;
constexpr std::size_t kSkipBytes = std::size_t{1} << 23;
constexpr std::size_t kSendAwayBytes = std::size_t{1} << 25;
constexpr std::size_t kMostDatagramBytes = 65507;
constexpr int kMostAtOnce = 64;  // connections, questions

}  // namespace

QtmServer::QtmServer(MarkerSequence recording, QtmServerOptions options)
    : options_(std::move(options)),
      recording_(std::move(recording)),
      columns_(recording_.labels()),
      rotation_(RotationToZUp(options_.up_axis).transpose() * kMillimetres),
      playback_(recording_.num_frames(), recording_.rate(), options_.playback),
      listener_(options_.address, options_.port) {
  if (options_.discovery_port) discovery_.emplace(options_.address, *options_.discovery_port, true);
}

QtmServer::~QtmServer() { Shutdown(); }

void QtmServer::Wait(std::chrono::nanoseconds most) {
  std::vector<WaitFor> sockets = {listener_.Waiting()};
  if (discovery_) sockets.push_back(discovery_->Waiting());
  bool is_streaming = false;
  for (const auto& session : sessions_) {
    sockets.push_back(session->connection.Waiting());
    is_streaming = is_streaming || session->is_streaming;
  }
  const bool plays = playback_.is_running() && (is_streaming || options_.playback.speed > 0);
  if (plays && !IsHeldUp()) most = std::min(most, playback_.UntilNext());
  WaitForSockets(sockets, most);
}

void QtmServer::Step(std::chrono::milliseconds wait) {
  Wait(wait);
  Accept();
  AnswerDiscovery();
  for (const auto& session : sessions_) {
    QtmConnection& connection = session->connection;
    std::string_view packet;
    if (!connection.Receive() && !connection.tcp().is_open()) continue;
    while (connection.tcp().is_open() && connection.bytes_to_send() <= kSendAwayBytes &&
           connection.Take(&packet)) {
      Answer(session.get(), packet);
    }
    if (connection.bytes_to_send() > kSendAwayBytes) connection.Close();
  }
  Play();
  Flush();
  std::erase_if(sessions_, [](const auto& s) { return !s->connection.tcp().is_open(); });
}

void QtmServer::Flush() {
  for (const auto& session : sessions_) session->connection.Flush();
}

void QtmServer::Accept() {
  TcpConnection connection;
  for (int i = 0; i < kMostAtOnce && listener_.Accept(&connection); ++i) {
    auto session = std::make_unique<Session>();
    session->connection.Use(std::move(connection));
    if (sessions_.size() < options_.most_clients) {
      session->connection.SendCommand("QTM RT Interface connected");
      sessions_.push_back(std::move(session));
    } else {
      AppendQtmText(QtmPacketType::kError, "Connection refused. Max number of clients reached.",
                    session->connection.out());
      session->connection.Flush();
    }
    connection = TcpConnection();
  }
}

void QtmServer::AnswerDiscovery() {
  UdpAddress sender;
  if (!discovery_) return;
  for (int i = 0; i < kMostAtOnce; ++i) {
    const auto datagram = discovery_->Receive(&sender);
    if (!datagram) return;
    try {
      sender.port = ParseQtmDiscovery(*datagram);
      discovery_->Send(FormatQtmAnnouncement({"MMMConverterS2KF, QTM 2.3 (build 0), 0 cameras",
                                              static_cast<std::uint16_t>(listener_.port() - 1)}),
                       sender);
    } catch (const Error&) {
      continue;  // no question that is known
    }
  }
}

bool QtmServer::IsHeldUp() const {
  return options_.playback.speed == 0 &&
         std::any_of(sessions_.begin(), sessions_.end(), [](const auto& session) {
           return session->is_streaming && session->connection.bytes_to_send() > kHoldUpBytes;
         });
}

void QtmServer::Begin() {
  if (playback_.is_running()) return;
  const bool is_again = playback_.has_ended();
  playback_.Start();
  if (is_again) Tell(QtmEvent::kRtFromFileStarted);
}

void QtmServer::Play() {
  if (!playback_.is_running() || IsHeldUp()) return;
  const bool is_fast = options_.playback.speed == 0;
  if (is_fast && std::none_of(sessions_.begin(), sessions_.end(),
                              [](const auto& session) { return session->is_streaming; })) {
    return;
  }
  while (const auto number = playback_.Take()) {
    MakeData(*number);
    for (const auto& session : sessions_) {
      const QtmStreamRequest& wish = session->wish;
      if (!session->is_streaming || !IsAskedFor(wish, *number, recording_.rate())) continue;
      if (session->connection.bytes_to_send() > kSkipBytes) continue;
      SendFrame(session.get(), wish.components);
    }
    if (is_fast) return;
  }
  if (!playback_.has_ended()) return;
  Tell(QtmEvent::kRtFromFileStopped);
  for (const auto& session : sessions_) {
    if (!std::exchange(session->is_streaming, false)) continue;
    AppendQtmPacket(QtmPacketType::kNoMoreData, "", session->connection.out());
  }
  current_.reset();
}

void QtmServer::MakeData(std::int64_t number) {
  current_ = number;
  data_.frame = static_cast<std::uint32_t>(number + 1);
  data_.camera_time = static_cast<std::uint64_t>(
      std::llround(static_cast<double>(number) / recording_.rate() * 1e6));
  const auto points = recording_.frame(playback_.FrameOf(number));
  data_.labelled.clear();
  for (const Eigen::Index column : columns_.labelled) {
    data_.labelled.push_back(ToPoint(points.col(column)));
  }
  data_.unlabelled.clear();
  for (const Eigen::Index column : columns_.unlabelled) {
    if (!IsSeen(points.col(column))) continue;
    data_.unlabelled.push_back(ToPoint(points.col(column)));
    data_.unlabelled.back().id = static_cast<std::uint32_t>(column + 1);
  }
}

QtmPoint QtmServer::ToPoint(const Eigen::Vector3d& p_WM) const {
  QtmPoint point;
  const Eigen::Vector3d p = rotation_ * p_WM;
  for (int axis = 0; axis < 3; ++axis) {
    point.position[axis] = static_cast<float>(IsSeen(p) ? p[axis] : kNaN);
  }
  return point;
}

void QtmServer::SendFrame(Session* session, const std::vector<QtmComponent>& components) {
  if (session->udp.port == 0) {
    AppendQtmData(data_, components, session->connection.out());
    return;
  }
  if (!udp_) udp_.emplace(options_.address, 0);
  packet_.clear();
  AppendQtmData(data_, components, &packet_);
  if (packet_.size() <= kMostDatagramBytes) {
    udp_->Send(packet_, session->udp);
    return;
  }
  for (const QtmComponent component : components) {
    packet_.clear();
    AppendQtmData(data_, {component}, &packet_);
    udp_->Send(packet_, session->udp);
  }
}

void QtmServer::Tell(QtmEvent event) {
  for (const auto& session : sessions_) AppendQtmEvent(event, session->connection.out());
}

void QtmServer::Replace(MarkerSequence recording) {
  const bool was_running = playback_.is_running();
  recording_ = std::move(recording);
  columns_ = PlayedColumns(recording_.labels());
  playback_ = Playback(recording_.num_frames(), recording_.rate(), options_.playback);
  current_.reset();
  if (was_running) playback_.Start();
  Tell(QtmEvent::kCameraSettingsChanged);
  Flush();
}

void QtmServer::Shutdown() {
  Tell(QtmEvent::kShuttingDown);
  Flush();
  sessions_.clear();
}

}  // namespace mmm_converter
