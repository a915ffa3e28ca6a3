// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/live/natnet/natnet_frame.h"
#include "common/live/natnet/natnet_message.h"
#include "common/live/natnet/natnet_model.h"
#include "common/live/net/udp_socket.h"
#include "common/live/playback/playback.h"
#include "common/live/playback/played_columns.h"
#include "common/math/up_axis.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter {

struct NatNetServerOptions {
  std::string address = "127.0.0.1";      ///< of this computer's interfaces, the one that is served
  int command_port = kNatNetCommandPort;  ///< 0: any
  int data_port = kNatNetDataPort;        ///< of multicast; announced
  std::string group;                      ///< of multicast; empty: unicast to who connects
  NatNetVersion version{4, 1};
  UpAxis up_axis = UpAxis::kY;      ///< of the stream
  std::string asset = "Recording";  ///< that wears the markers
  std::size_t most_clients = 32;
  PlaybackOptions playback;
};

/// Plays a recording as Motive streams it. Unicast, it begins with the first client that connects
/// and, where it has ended, with the next one; multicast, at once. Without threads: Step is to be
/// called again and again.
class NatNetServer {
 public:
  /// recording: [m], z up. @throws Error where the port is taken, or a frame has no room in a
  /// datagram.
  NatNetServer(MarkerSequence recording, NatNetServerOptions options);
  ~NatNetServer();
  NatNetServer(const NatNetServer&) = delete;
  NatNetServer& operator=(const NatNetServer&) = delete;

  int command_port() const { return command_.port(); }
  std::size_t num_clients() const { return clients_.size(); }
  const Playback& playback() const { return playback_; }

  /// Does what there is to do, waiting for it at most so long. Sends at most one frame if it plays
  /// as fast as it can.
  void Step(std::chrono::milliseconds wait);
  /// Another recording from now on; frames say that the model has changed.
  void Replace(MarkerSequence recording);
  /// Tells the clients that the connection ends.
  void Shutdown();

 private:
  struct Client {
    UdpAddress address;
    NatNetVersion version;
    SteadyTime heard_of;
  };

  bool is_multicast() const { return !options_.group.empty(); }
  void Answer(const NatNetMessage& message, const UdpAddress& sender);
  void AnswerRequest(std::string_view text, const UdpAddress& sender);
  void SendModel(const UdpAddress& to);
  void SendServerInfo(const UdpAddress& to);
  void Send(NatNetId id, std::string_view payload, const UdpAddress& to);
  void TakeClient(const UdpAddress& address);
  Client* FindClient(const UdpAddress& address);
  NatNetVersion VersionOf(const UdpAddress& address);
  void ForgetSilentClients();
  void Play();
  void SendFrame();
  const std::string& FrameMessage(const NatNetVersion& version);
  void TakeWishedVersion(std::string_view payload, const UdpAddress& address);
  void MakeFrame(std::int64_t number);
  std::uint64_t Ticks() const;
  void CheckSize();

  NatNetServerOptions options_;
  MarkerSequence recording_;
  PlayedColumns columns_;  // of it
  NatNetModel model_;
  Eigen::Matrix3d rotation_;  // z up to the stream's axes
  Playback playback_;
  UdpSocket command_;
  UdpAddress group_;
  std::vector<Client> clients_;
  bool model_is_new_ = false;                      // since the last frame
  NatNetFrame frame_;                              // that was played last
  std::map<NatNetVersion, std::string> messages_;  // of a frame
};

}  // namespace mmm_converter
