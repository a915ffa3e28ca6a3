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
constexpr int kDatagramsAtOnce = 64;
constexpr const char* kOwnName = "MMMConverterS2KF";

}  // namespace

NatNetSource::NatNetSource(NatNetSourceOptions options)
    : ConnectedSource(options.now),
      options_(std::move(options)),
      rotation_(RotationToZUp(options_.up_axis)) {}

NatNetSource::~NatNetSource() {
  if (command_ && server_.port != 0 && !is_multicast_) Send(NatNetId::kDisconnect);
}

void NatNetSource::Wait(std::chrono::nanoseconds most) {
  const std::array sockets = {command_ ? command_->Waiting() : WaitFor(),
                              data_ ? data_->Waiting() : WaitFor()};
  if (is_connected()) most = std::min(most, std::min(limit_, ask_again_at_) - now());
  WaitForSockets(sockets, most);
}

void NatNetSource::Disconnect() {
  command_.reset();
  data_.reset();
}

std::string NatNetSource::Server() const {
  return options_.host.empty()
             ? "natnet://"
             : fmt::format("NatNet server at {}:{}", options_.host, options_.command_port);
}

NatNetSource::Event NatNetSource::Advance(StreamFrame* frame) {
  for (int i = 0; i < kDatagramsAtOnce; ++i) {
    UdpAddress sender;
    auto datagram = data_ ? data_->Receive(&sender) : std::nullopt;
    if (!datagram) datagram = command_->Receive(&sender);
    if (!datagram) break;
    received_ = std::chrono::steady_clock::now();
    if (const Event event = Handle(*datagram, sender, frame)) return event;
    if (!is_connected()) return std::nullopt;
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
  step_ = Step::kConnecting;
  limit_ = now() + kConnectLimit;
  Ask();
  return std::nullopt;
}

void NatNetSource::Send(NatNetId id, std::string_view payload) {
  command_->Send(FormatNatNetMessage(id, payload), server_);
}

void NatNetSource::Ask() {
  ask_again_at_ = now() + (step_ == Step::kStreaming ? kKeepAlivePeriod : kAskAgain);
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
  if (now() >= limit_) {
    switch (step_) {
      case Step::kConnecting:
        return Lose("no answer",
                    "start Motive there, turn its streaming on (Settings > Streaming), and check "
                    "the address and the firewall");
      case Step::kModel:
        if (has_model_) return BeginStreaming();  // of a server that does not tell its rate
        return Lose("it does not describe what it streams",
                    "check the streaming settings of Motive");
      default:
        return Lose("no frames for some seconds",
                    is_multicast_ ? "check that Motive plays or records, and that multicast gets "
                                    "through: the interface, the firewall; or stream unicast"
                                  : "check that Motive plays or records");
    }
  }
  if (now() < ask_again_at_) return std::nullopt;
  // A rate is no longer waited for than until it is asked for again.
  if (step_ == Step::kModel && has_model_) return BeginStreaming();
  Ask();
  return std::nullopt;
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

std::unique_ptr<FrameSource> OpenNatNetSource(const StreamAddress& address, bool needs_labels) {
  address.AllowOnly({"multicast", "data", "local", "up"});
  NatNetSourceOptions options;
  options.needs_labels = needs_labels;
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
