// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/live/frame_source.h"
#include "common/live/net/udp_socket.h"
#include "common/live/qtm/qtm_connection.h"
#include "common/live/qtm/qtm_data.h"
#include "common/live/qtm/qtm_parameters.h"
#include "common/live/stream_address.h"

namespace mmm_converter {

inline constexpr int kQtmPort = 22223;  ///< base port + 1: TCP, little endian

struct QtmSourceOptions {
  std::string host;     ///< empty: the only one that answers in the network
  int port = kQtmPort;  ///< TCP, little endian
  int newest_minor = 25;
  bool udp = false;  ///< data by UDP, which may lose some, instead of TCP
  int discovery_port = kQtmDiscoveryPort;
  std::function<SteadyTime()> now = [] { return std::chrono::steady_clock::now(); };
};

/// Labelled points of Qualisys QTM by its real-time protocol.
class QtmSource : public FrameSource {
 public:
  explicit QtmSource(QtmSourceOptions options);

  StreamEvent Next(std::chrono::milliseconds wait, StreamFrame* frame) override;
  const StreamLayout& layout() const override { return layout_; }
  const std::string& message() const override { return message_; }
  const StreamCounts& counts() const override { return counts_; }

 private:
  using Event = std::optional<StreamEvent>;
  enum class Step {
    kWaiting,      // until it is time to connect again
    kDiscovering,  // for answers of servers
    kConnecting,
    kGreeting,
    kVersion,
    kSoftware,    // which QTM it is
    kParameters,  // before the first frame of a connection
    kStreaming,
  };

  Event Advance(StreamFrame* frame);
  void Wait(std::chrono::milliseconds most);
  void Go(Step step, std::chrono::milliseconds limit);
  Event Connect();
  Event Discover();
  Event CheckTime();
  /// Ends the connection: an error if it is the first, else it is tried again later.
  Event Lose(const std::string& reason, const std::string& remedy = "");
  /// No frames for the time being; the connection stays.
  Event Pause(const std::string& reason);
  Event Say(const std::string& reason);
  std::string Server() const;

  Event Handle(std::string_view bytes, StreamFrame* frame);
  Event HandleText(const QtmPacket& packet);
  Event HandleVersion(const QtmPacket& packet);
  Event HandleEvent(QtmEvent event);
  Event HandleParameters(const QtmPacket& packet);
  Event HandleData(const QtmPacket& packet, StreamFrame* frame);
  Event FillFrame(StreamFrame* frame);
  void CountLost(std::int64_t number);
  void AskForParameters();
  void StartStream();

  QtmSourceOptions options_;
  QtmConnection connection_;
  std::optional<UdpSocket> udp_;  // of discovery, or of the data
  std::vector<std::pair<UdpAddress, QtmAnnouncement>> announcements_;
  Step step_ = Step::kWaiting;
  SteadyTime limit_;     // of the step
  SteadyTime retry_at_;  // kWaiting
  std::chrono::milliseconds retry_wait_;
  int minor_ = 0;
  std::string software_;  // "QTM 2.3 (build 464)"

  QtmParameters parameters_;
  Eigen::Matrix3d rotation_ = Eigen::Matrix3d::Identity();  // mm in the lab's axes to m, z up
  StreamLayout layout_;
  bool had_layout_ = false;
  bool layout_is_due_ = false;       // before the next frame
  bool is_lost_ = false;             // which has been said
  bool is_paused_ = false;           // by the server
  bool awaits_parameters_ = false;   // kStreaming
  bool restarts_stream_ = false;     // when they are there
  bool asks_for_unlabelled_ = true;  // points
  std::string pause_reason_;         // of an event that no frames may follow
  SteadyTime asked_at_;              // for parameters, because of the data

  QtmData data_;
  bool data_is_pending_ = false;  // kLayout was said before it
  bool has_more_ = false;         // has been received than was read
  SteadyTime received_;
  std::int64_t last_number_ = -1;
  std::string message_;
  StreamCounts counts_;
};

/// qtm://HOST[:PORT] with ?version=1.19, ?udp=yes, ?discovery=PORT. @throws Error
std::unique_ptr<FrameSource> OpenQtmSource(const StreamAddress& address);

}  // namespace mmm_converter
