// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/live/frame_source.h"
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
  std::function<SteadyTime()> now = [] { return std::chrono::steady_clock::now(); };
};

/// Labelled points of OptiTrack Motive by NatNet, unicast or multicast.
class NatNetSource : public FrameSource {
 public:
  explicit NatNetSource(NatNetSourceOptions options);
  ~NatNetSource() override;
  NatNetSource(const NatNetSource&) = delete;
  NatNetSource& operator=(const NatNetSource&) = delete;

  StreamEvent Next(std::chrono::milliseconds wait, StreamFrame* frame) override;
  const StreamLayout& layout() const override { return layout_; }
  const std::string& message() const override { return message_; }
  const StreamCounts& counts() const override { return counts_; }

 private:
  using Event = std::optional<StreamEvent>;
  enum class Step {
    kWaiting,     // until it is time to connect again
    kConnecting,  // for the server's description of itself
    kModel,       // for its model definition, and its rate
    kStreaming,
  };

  Event Advance(StreamFrame* frame);
  Event Connect();
  Event CheckTime();
  Event Lose(const std::string& reason, const std::string& remedy = "");
  std::string Server() const;
  void Send(NatNetId id, std::string_view payload = {});
  void Ask();  // again what the step waits for
  void AskForModel();
  void OpenData();

  Event Handle(std::string_view datagram, const UdpAddress& sender, StreamFrame* frame);
  Event HandleServerInfo(std::string_view payload, const UdpAddress& sender);
  Event HandleModel(std::string_view payload);
  Event HandleResponse(std::string_view payload);
  Event HandleFrame(std::string_view payload, StreamFrame* frame);
  Event TakeLayout();
  Event FillFrame(StreamFrame* frame);

  NatNetSourceOptions options_;
  std::optional<UdpSocket> command_, data_;
  UdpAddress server_;
  Step step_ = Step::kWaiting;
  SteadyTime limit_, ask_again_at_;  // of the step
  SteadyTime retry_at_;              // kWaiting
  std::chrono::milliseconds retry_wait_;
  SteadyTime model_asked_at_, version_asked_at_;  // because of frames

  NatNetServerInfo info_;
  bool is_multicast_ = false;
  Eigen::Matrix3d rotation_;
  NatNetColumns columns_;
  bool has_model_ = false;  // of this connection
  double rate_ = 0;
  StreamLayout layout_;
  bool had_layout_ = false;
  bool layout_is_due_ = false;  // before the next frame
  bool is_lost_ = false;        // which has been said

  NatNetFrame frame_;
  bool frame_is_pending_ = false;  // kLayout was said before it
  SteadyTime received_;
  std::int64_t last_number_ = -1;
  std::string message_;
  StreamCounts counts_;
};

/// natnet://HOST[:COMMAND PORT] with ?multicast=GROUP, ?data=PORT, ?local=ADDRESS, ?up=z.
/// @throws Error
std::unique_ptr<FrameSource> OpenNatNetSource(const StreamAddress& address);

}  // namespace mmm_converter
