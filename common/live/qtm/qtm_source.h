// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/live/connected_source.h"
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
  bool needs_labels = true;  ///< a system that has none is an error
  std::function<SteadyTime()> now = [] { return std::chrono::steady_clock::now(); };
};

/// Labelled points of Qualisys QTM by its real-time protocol.
class QtmSource : public ConnectedSource {
 public:
  explicit QtmSource(QtmSourceOptions options);

 private:
  static constexpr std::chrono::milliseconds kAnswerLimit{5000};
  static constexpr std::chrono::milliseconds kSilence{5000};  // of a stream: it is lost
  enum class Step {
    kDiscovering,  // for answers of servers
    kConnecting,
    kGreeting,
    kVersion,
    kSoftware,    // which QTM it is
    kParameters,  // before the first frame of a connection
    kStreaming,
  };

  Event Connect() override;
  Event Advance(StreamFrame* frame) override;
  Event FillFrame(StreamFrame* frame) override;
  void FillPoints(const std::vector<QtmPoint>& from, Eigen::Ref<Eigen::Matrix3Xd> to) const;
  void Wait(std::chrono::nanoseconds most) override;
  void Disconnect() override;
  std::string Server() const override;

  void Go(Step step, std::chrono::milliseconds limit);
  Event Discover();
  Event CheckTime();
  /// No frames for the time being; the connection stays.
  Event Pause(const std::string& reason);

  Event Handle(std::string_view bytes, StreamFrame* frame);
  Event HandleText(const QtmPacket& packet);
  Event HandleVersion(const QtmPacket& packet);
  Event HandleEvent(QtmEvent event);
  Event HandleParameters(const QtmPacket& packet);
  Event HandleData(const QtmPacket& packet, StreamFrame* frame);
  void AskForParameters();
  void StartStream();

  QtmSourceOptions options_;
  QtmConnection connection_;
  std::optional<UdpSocket> udp_;  // of discovery, or of the data
  std::vector<std::pair<UdpAddress, QtmAnnouncement>> announcements_;
  Step step_ = Step::kConnecting;
  SteadyTime limit_;  // of the step
  int minor_ = 0;
  std::string software_;  // "QTM 2.3 (build 464)"

  QtmParameters parameters_;
  Eigen::Matrix3d rotation_ = Eigen::Matrix3d::Identity();  // mm in the lab's axes to m, z up
  bool is_paused_ = false;                                  // by the server
  bool awaits_parameters_ = false;                          // kStreaming
  bool restarts_stream_ = false;                            // when they are there
  bool asks_for_unlabelled_ = true;                         // points
  std::string pause_reason_;                                // of an event that no frames may follow
  SteadyTime asked_at_;                                     // for parameters, because of the data

  QtmData data_;
  bool has_more_ = false;  // has been received than was read
  SteadyTime received_;
};

/// qtm://HOST[:PORT] with ?version=1.19, ?udp=yes, ?discovery=PORT. @throws Error
std::unique_ptr<FrameSource> OpenQtmSource(const StreamAddress& address, bool needs_labels = true);

}  // namespace mmm_converter
