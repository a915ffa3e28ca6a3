// SPDX-License-Identifier: MIT
// What NatNetSource does with what comes.
#include <fmt/format.h>

#include "common/live/natnet/natnet_layout.h"
#include "common/live/natnet/natnet_source.h"
#include "common/live/wire/broken_message.h"
#include "common/live/wire/byte_reader.h"
#include "common/motion/marker_sequence.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kModelLimit{3000};
constexpr milliseconds kFrameLimit{5000};
constexpr milliseconds kAskOnceIn{1000};

}  // namespace

NatNetSource::Event NatNetSource::Handle(std::string_view datagram, const UdpAddress& sender,
                                         StreamFrame* frame) {
  try {
    const NatNetMessage message = ParseNatNetMessage(datagram);
    switch (message.id) {
      case NatNetId::kServerInfo:
        return HandleServerInfo(message.payload, sender);
      case NatNetId::kModel:
        return step_ == Step::kConnecting ? std::nullopt : HandleModel(message.payload);
      case NatNetId::kResponse:
        return HandleResponse(message.payload);
      case NatNetId::kFrame:
        return step_ == Step::kStreaming ? HandleFrame(message.payload, frame) : std::nullopt;
      case NatNetId::kDisconnect:
      case NatNetId::kDisconnectByTimeout:
        return Lose("it has ended the connection");
      default:
        return std::nullopt;
    }
  } catch (const BrokenMessage&) {
    CountBroken();
    return std::nullopt;
  }
}

NatNetSource::Event NatNetSource::HandleServerInfo(std::string_view payload,
                                                   const UdpAddress& sender) {
  const NatNetServerInfo info = ParseNatNetServerInfo(payload);
  const bool is_first = step_ == Step::kConnecting;
  if (!is_first && info.version == info_.version) return std::nullopt;
  info_ = info;
  if (info_.version < kOldestNatNet) {
    return Lose(
        fmt::format("it speaks NatNet {}", Format(info_.version)),
        fmt::format("update it; {} is the oldest that is understood here", Format(kOldestNatNet)));
  }
  if (is_first) {
    if (server_.port == 0) {
      server_ = sender;
      options_.host = FormatIp(sender);
      options_.command_port = sender.port;
      Send(NatNetId::kConnect, FormatNatNetConnect("MMMConverterS2KF", kNewestNatNet));
    }
    OpenData();
    CountConnection();
  }
  has_model_ = false;
  step_ = Step::kModel;
  limit_ = now() + kModelLimit;
  Ask();
  return std::nullopt;
}

void NatNetSource::AskForModel() {
  if (now() < model_asked_at_ + kAskOnceIn) return;
  model_asked_at_ = now();
  Send(NatNetId::kRequestModel);
}

NatNetSource::Event NatNetSource::HandleModel(std::string_view payload) {
  NatNetColumns columns(ParseNatNetModel(payload, info_.version), info_.version);
  if (columns.labels().empty() && options_.needs_labels) {
    return Lose("it streams no named markers",
                "in Motive, make or enable an asset of the markers, and turn on that labeled "
                "markers and marker sets are streamed; or have the points named by the body");
  }
  columns_ = std::move(columns);
  has_model_ = true;
  if (step_ == Step::kModel && rate_ == 0) return std::nullopt;
  return BeginStreaming();
}

NatNetSource::Event NatNetSource::HandleResponse(std::string_view payload) {
  if (payload.size() < sizeof(float) || step_ != Step::kModel) return std::nullopt;
  const auto rate = ByteReader(payload).Take<float>();
  if (!IsFrameRate(rate)) return std::nullopt;
  rate_ = rate;
  return has_model_ ? BeginStreaming() : std::nullopt;
}

NatNetSource::Event NatNetSource::BeginStreaming() {
  const Event event = TakeLayout(
      {fmt::format("{} {}.{}, NatNet {}", info_.application, info_.application_version[0],
                   info_.application_version[1], Format(info_.version)),
       columns_.labels(), rate_});
  if (!is_connected()) return event;
  if (step_ == Step::kModel) {
    step_ = Step::kStreaming;
    limit_ = now() + kFrameLimit;
    Ask();
  }
  return event;
}

NatNetSource::Event NatNetSource::HandleFrame(std::string_view payload, StreamFrame* frame) {
  ParseNatNetFrame(payload, info_.version, &frame_);
  limit_ = now() + kFrameLimit;
  if ((frame_.parameters & kNatNetModelChanged) != 0) AskForModel();
  if ((frame_.parameters & kNatNetVersionChanged) != 0 && info_.version >= kNatNet4 &&
      now() >= version_asked_at_ + kAskOnceIn) {
    version_asked_at_ = now();
    Send(NatNetId::kConnect, FormatNatNetConnect("MMMConverterS2KF", kNewestNatNet));
  }
  return FrameCame(frame);
}

NatNetSource::Event NatNetSource::FillFrame(StreamFrame* frame) {
  frame->number = frame_.number;
  if (info_.version >= kNatNetWithBodyParameters) {
    frame->time = frame_.time;
  } else {
    frame->time = rate_ > 0 ? frame_.number / rate_ : frame_.latency;
  }
  frame->received = received_;
  const NatNetColumns::Rest rest = columns_.Fill(frame_, &frame->points, &unnamed_);
  if (rest.has_new_asset) AskForModel();
  for (Eigen::Index i = 0; i < frame->points.cols(); ++i) {
    const Eigen::Vector3d p = frame->points.col(i);
    frame->points.col(i).noalias() = rotation_ * p;
  }
  SetUnnamed(unnamed_.size(), frame);
  for (int i = 0; i < frame->unnamed; ++i) {
    frame->unnamed_points.col(i).noalias() = rotation_ * unnamed_[static_cast<std::size_t>(i)];
  }
  return CountFrame(frame->number);
}

}  // namespace mmm_converter
