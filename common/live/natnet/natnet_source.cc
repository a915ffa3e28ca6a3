// SPDX-License-Identifier: MIT
#include "common/live/natnet/natnet_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "common/live/natnet/natnet_layout.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kConnectLimit{3000};
constexpr milliseconds kAskAgain{500};
constexpr milliseconds kKeepAlivePeriod{1000};
constexpr milliseconds kShortestRetry{500};
constexpr milliseconds kLongestRetryWait{8000};
constexpr int kDatagramsAtOnce = 64;
constexpr const char* kOwnName = "MMMConverterS2KF";

}  // namespace

NatNetSource::NatNetSource(NatNetSourceOptions options)
    : options_(std::move(options)),
      retry_at_(options_.now()),
      retry_wait_(kShortestRetry),
      rotation_(RotationToZUp(options_.up_axis)) {}

NatNetSource::~NatNetSource() {
  if (command_ && server_.port != 0 && !is_multicast_) Send(NatNetId::kDisconnect);
}

StreamEvent NatNetSource::Next(milliseconds wait, StreamFrame* frame) {
  const SteadyTime end = std::chrono::steady_clock::now() + wait;
  while (true) {
    if (const Event event = Advance(frame)) return *event;
    const auto left = std::chrono::ceil<milliseconds>(end - std::chrono::steady_clock::now());
    if (left.count() <= 0) return StreamEvent::kNothing;
    const SteadyTime until = step_ == Step::kWaiting ? retry_at_ : std::min(limit_, ask_again_at_);
    const std::array sockets = {command_ ? command_->Waiting() : WaitFor(),
                                data_ ? data_->Waiting() : WaitFor()};
    WaitForSockets(sockets,
                   std::min(left, std::chrono::ceil<milliseconds>(until - options_.now())));
  }
}

std::string NatNetSource::Server() const {
  return options_.host.empty()
             ? "natnet://"
             : fmt::format("NatNet server at {}:{}", options_.host, options_.command_port);
}

NatNetSource::Event NatNetSource::Advance(StreamFrame* frame) {
  if (frame_is_pending_) return FillFrame(frame);
  if (step_ == Step::kWaiting) {
    if (options_.now() < retry_at_) return std::nullopt;
    if (const Event event = Connect()) return event;
  }
  for (int i = 0; i < kDatagramsAtOnce; ++i) {
    UdpAddress sender;
    auto datagram = data_ ? data_->Receive(&sender) : std::nullopt;
    if (!datagram) datagram = command_->Receive(&sender);
    if (!datagram) break;
    received_ = std::chrono::steady_clock::now();
    if (const Event event = Handle(*datagram, sender, frame)) return event;
    if (step_ == Step::kWaiting) return std::nullopt;
  }
  return CheckTime();
}

NatNetSource::Event NatNetSource::Connect() {
  command_.emplace(options_.local_address, 0);
  data_.reset();
  server_ = {};
  if (options_.host.empty()) {
    command_->AllowBroadcast();
  } else {
    try {
      server_ = FindUdpAddress(options_.host, options_.command_port);
    } catch (const Error& error) {
      return Lose(error.what());
    }
  }
  has_model_ = false;
  rate_ = 0;
  last_number_ = -1;
  step_ = Step::kConnecting;
  limit_ = options_.now() + kConnectLimit;
  Ask();
  return std::nullopt;
}

void NatNetSource::Send(NatNetId id, std::string_view payload) {
  command_->Send(FormatNatNetMessage(id, payload), server_);
}

void NatNetSource::Ask() {
  ask_again_at_ = options_.now() + (step_ == Step::kStreaming ? kKeepAlivePeriod : kAskAgain);
  switch (step_) {
    case Step::kConnecting:
      if (server_.port != 0) {
        Send(NatNetId::kConnect, FormatNatNetConnect(kOwnName, kNewestNatNet));
        return;
      }
      for (const char* host : {"255.255.255.255", "127.0.0.1"}) {
        command_->Send(
            FormatNatNetMessage(NatNetId::kDiscovery, FormatNatNetConnect(kOwnName, kNewestNatNet)),
            FindUdpAddress(host, options_.command_port));
      }
      return;
    case Step::kModel:
      if (!has_model_) Send(NatNetId::kRequestModel);
      if (rate_ == 0) Send(NatNetId::kRequest, std::string_view("FrameRate\0", 10));
      return;
    case Step::kStreaming:
      if (!is_multicast_) Send(NatNetId::kKeepAlive);
      return;
    default:
      return;
  }
}

NatNetSource::Event NatNetSource::CheckTime() {
  if (options_.now() >= limit_) {
    switch (step_) {
      case Step::kConnecting:
        return Lose("no answer",
                    "start Motive there, turn its streaming on (Settings > Streaming), and check "
                    "the address and the firewall");
      case Step::kModel:
        if (has_model_) return TakeLayout();  // of a server that does not tell its rate
        return Lose("it does not describe what it streams",
                    "check the streaming settings of Motive");
      default:
        return Lose("no frames for some seconds",
                    is_multicast_ ? "check that Motive plays or records, and that multicast gets "
                                    "through: the interface, the firewall; or stream unicast"
                                  : "check that Motive plays or records");
    }
  }
  if (options_.now() < ask_again_at_) return std::nullopt;
  // A rate is no longer waited for than until it is asked for again.
  if (step_ == Step::kModel && has_model_) return TakeLayout();
  Ask();
  return std::nullopt;
}

NatNetSource::Event NatNetSource::Lose(const std::string& reason, const std::string& remedy) {
  const std::string whole =
      fmt::format("{}: {}{}{}", Server(), reason, remedy.empty() ? "" : "; ", remedy);
  command_.reset();
  data_.reset();
  if (!had_layout_) throw Error(whole);
  step_ = Step::kWaiting;
  retry_at_ = options_.now() + retry_wait_;
  retry_wait_ = std::min(2 * retry_wait_, kLongestRetryWait);
  if (is_lost_) return std::nullopt;
  is_lost_ = layout_is_due_ = true;
  message_ = whole;
  return StreamEvent::kLost;
}

void NatNetSource::OpenData() {
  const std::string group =
      !options_.group.empty() ? options_.group : (info_.is_multicast ? info_.group : "");
  const int port = options_.data_port.value_or(info_.data_port);
  is_multicast_ = !group.empty();
  data_.reset();
  if (is_multicast_) {
    data_.emplace("", port, true);
    data_->Join(group, options_.local_address.empty() ? LocalAddressTowards(server_)
                                                      : options_.local_address);
    return;
  }
  // Motive sends unicast to where it was asked from. Other servers send it to the data port, and
  // old ones do not say that they stream to the group.
  const bool may_be_multicast = info_.version < kNatNet3;
  try {
    data_.emplace("", port, may_be_multicast);
    if (may_be_multicast) {
      data_->Join(kNatNetGroup, options_.local_address.empty() ? LocalAddressTowards(server_)
                                                               : options_.local_address);
    }
  } catch (const Error&) {
    return;  // another program has the port, or the network has no multicast
  }
}

std::unique_ptr<FrameSource> OpenNatNetSource(const StreamAddress& address) {
  address.AllowOnly({"multicast", "data", "local", "up"});
  NatNetSourceOptions options;
  options.host = address.host;
  options.command_port = address.port.value_or(options.command_port);
  options.data_port = address.GetPort("data");
  options.local_address = address.Get("local").value_or("");
  if (const auto group = address.Get("multicast")) {
    options.group = group->empty() ? kNatNetGroup : *group;
  }
  if (const auto axis = address.Get("up")) options.up_axis = ParseUpAxis(*axis);
  return std::make_unique<NatNetSource>(std::move(options));
}

}  // namespace mmm_converter
