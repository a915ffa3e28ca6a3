// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/live/net/tcp_connection.h"
#include "common/live/net/udp_socket.h"
#include "common/live/playback/playback.h"
#include "common/live/playback/played_columns.h"
#include "common/live/qtm/qtm_commands.h"
#include "common/live/qtm/qtm_connection.h"
#include "common/live/qtm/qtm_data.h"
#include "common/live/qtm/qtm_source.h"
#include "common/math/up_axis.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter {

struct QtmServerOptions {
  std::string address = "127.0.0.1";  ///< of this computer's interfaces, the one that is served
  int port = kQtmPort;                ///< TCP, little endian; 0: any
  int newest_minor = kNewestQtmMinor;
  std::size_t most_clients = 10;
  UpAxis up_axis = UpAxis::kZ;        ///< of the lab that is streamed
  std::optional<int> discovery_port;  ///< nothing: can't be discovered
  PlaybackOptions playback;
};

/// Plays a recording as QTM plays a file in real time ("RT from file"). It begins with the first
/// client that asks for frames and, where it has ended, with the next one. Without threads: Step is
/// to be called again and again.
class QtmServer {
 public:
  /// recording: [m], z up. @throws Error where the port is taken.
  QtmServer(MarkerSequence recording, QtmServerOptions options);
  ~QtmServer();
  QtmServer(const QtmServer&) = delete;
  QtmServer& operator=(const QtmServer&) = delete;

  int port() const { return listener_.port(); }
  int discovery_port() const { return discovery_ ? discovery_->port() : 0; }
  std::size_t num_clients() const { return sessions_.size(); }
  const Playback& playback() const { return playback_; }

  /// Does what there is to do, waiting for it at most so long. Sends at most one frame if it plays
  /// as fast as it can.
  void Step(std::chrono::milliseconds wait);
  /// Another recording from now on; clients are told that settings have changed.
  void Replace(MarkerSequence recording);
  /// Tells the clients, and ends their connections.
  void Shutdown();

 private:
  struct Session {
    QtmConnection connection{std::size_t{1} << 16};  // [bytes] of a command
    int minor = -1;                                  // of the version; -1: not set yet
    QtmStreamRequest wish;                           // of the stream
    bool is_streaming = false;
    UdpAddress udp;  // port 0: by TCP
  };

  void Wait(std::chrono::nanoseconds most);
  void Accept();
  void Answer(Session* session, std::string_view bytes);
  void AnswerWithVersion(Session* session, const std::vector<std::string>& words);
  void AnswerDiscovery();
  void SetVersion(Session* session, const std::vector<std::string>& words);
  void StartStream(Session* session, const std::vector<std::string>& words);
  void SendCurrentFrame(Session* session, const std::vector<std::string>& words);
  void SendParameters(Session* session, const std::vector<std::string>& words);
  void Begin();
  bool IsHeldUp() const;
  void Play();
  void SendFrame(Session* session, const std::vector<QtmComponent>& components);
  void MakeData(std::int64_t number);
  QtmPoint ToPoint(const Eigen::Vector3d& p_WM) const;
  void Tell(QtmEvent event);
  void Flush();

  QtmServerOptions options_;
  MarkerSequence recording_;
  PlayedColumns columns_;     // of it
  Eigen::Matrix3d rotation_;  // m, z up to mm in the lab's axes
  Playback playback_;
  TcpListener listener_;
  std::optional<UdpSocket> discovery_, udp_;
  std::vector<std::unique_ptr<Session>> sessions_;
  std::optional<std::int64_t> current_;  // running number of the frame that was played last
  QtmData data_;                         // of it
  std::string packet_;
};

}  // namespace mmm_converter
