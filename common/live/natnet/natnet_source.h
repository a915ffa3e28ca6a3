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
#include "common/live/natnet/natnet_columns.h"
#include "common/live/natnet/natnet_message.h"
#include "common/live/net/udp_socket.h"
#include "common/live/stream_address.h"
#include "common/math/up_axis.h"

namespace mmm_converter {

struct NatNetSourceOptions {
  std::string host;  ///< empty: the first that answers in the network
  int command_port = kNatNetCommandPort;
  std::string group;             ///< of multicast; empty: as the server says (from 3.0 on)
  std::optional<int> data_port;  ///< nothing: as the server says (from 3.0 on), or 1511
  std::string local_address;     ///< of the interface; empty: the one towards the server
  UpAxis up_axis = UpAxis::kY;   ///< in the stream, which does not say it
  bool needs_labels = true;      ///< a system that has none is an error
  std::function<SteadyTime()> now = [] { return std::chrono::steady_clock::now(); };
};

/// Labelled points of OptiTrack Motive by NatNet, unicast or multicast.
class NatNetSource : public ConnectedSource {
 public:
  explicit NatNetSource(NatNetSourceOptions options);
  ~NatNetSource() override;
  NatNetSource(const NatNetSource&) = delete;
  NatNetSource& operator=(const NatNetSource&) = delete;

 private:
  enum class Step {
    kConnecting,  // for the server's description of itself
    kModel,       // for its model definition, and its rate
    kStreaming,
  };

  Event Connect() override;
  Event Advance(StreamFrame* frame) override;
  Event FillFrame(StreamFrame* frame) override;
  void Wait(std::chrono::nanoseconds most) override;
  void Disconnect() override;
  std::string Server() const override;

  Event CheckTime();
  void Send(NatNetId id, std::string_view payload = {});
  void Ask();  // again what the step waits for
  void AskForModel();
  void OpenData();

  Event Handle(std::string_view datagram, const UdpAddress& sender, StreamFrame* frame);
  Event HandleServerInfo(std::string_view payload, const UdpAddress& sender);
  Event HandleModel(std::string_view payload);
  Event HandleResponse(std::string_view payload);
  Event HandleFrame(std::string_view payload, StreamFrame* frame);
  Event BeginStreaming();

  NatNetSourceOptions options_;
  std::optional<UdpSocket> command_, data_;
  UdpAddress server_;
  Step step_ = Step::kConnecting;
  SteadyTime limit_, ask_again_at_;               // of the step
  SteadyTime model_asked_at_, version_asked_at_;  // because of frames

  NatNetServerInfo info_;
  bool is_multicast_ = false;
  Eigen::Matrix3d rotation_;
  NatNetColumns columns_;
  bool has_model_ = false;  // of this connection
  double rate_ = 0;

  NatNetFrame frame_;
  std::vector<Eigen::Vector3d> unnamed_;  // points of it
  SteadyTime received_;
};

/// natnet://HOST[:COMMAND PORT] with ?multicast=GROUP, ?data=PORT, ?local=ADDRESS, ?up=z.
/// @throws Error
std::unique_ptr<FrameSource> OpenNatNetSource(const StreamAddress& address,
                                              bool needs_labels = true);

}  // namespace mmm_converter
