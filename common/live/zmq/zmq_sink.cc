// SPDX-License-Identifier: MIT
#include "common/live/zmq/zmq_sink.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>
#include <zmq.hpp>

#include "common/live/stream_address.h"
#include "common/live/zmq/posture_message.h"
#include "common/live/zmq/subscriber_guard.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

constexpr int kZmqPort = 5556;
constexpr int kMostWaiting = 64;  // messages for a subscriber
// Of what a subscriber says: its properties and topics. Beyond, ZeroMQ ends the connection.
constexpr std::int64_t kMostMessageBytes = 256;
constexpr int kMostUnread = 16;   // messages of a subscriber
constexpr int kHandshake = 5000;  // [ms] until a connection is a subscriber

class ZmqSink : public PoseSink {
 public:
  explicit ZmqSink(const std::string& address)
      : name_(address), socket_(context_, zmq::socket_type::pub) {
    const StreamAddress at = ParseStreamAddress(address);
    at.AllowOnly({});
    const std::string host = at.HostOr("127.0.0.1");
    const int port = at.port.value_or(kZmqPort);
    guard_.emplace(context_.handle(), socket_.handle(), port);
    try {
      socket_.set(zmq::sockopt::sndhwm, kMostWaiting);
      socket_.set(zmq::sockopt::rcvhwm, kMostUnread);
      socket_.set(zmq::sockopt::maxmsgsize, kMostMessageBytes);
      socket_.set(zmq::sockopt::handshake_ivl, kHandshake);
      socket_.set(zmq::sockopt::linger, 0);
      socket_.set(zmq::sockopt::ipv6, host.find(':') != std::string::npos);
      socket_.bind(fmt::format("tcp://{}:{}", InAddress(host), port));
    } catch (const zmq::error_t& error) {
      throw Error(fmt::format(
          "{}: can't publish there: {}; choose another port or an address of this computer",
          address, error.what()));
    }
  }

  std::string name() const override { return name_; }

  void Write(const std::shared_ptr<const LiveBody>& body, const PoseFrame& frame) override {
    formats_.resize(static_cast<std::size_t>(std::max(1, body->count)));
    Formatted& one = formats_[static_cast<std::size_t>(body->index)];
    if (body != one.body) {
      one.body = body;
      one.format.emplace(*body);
      one.topic = body->index == 0 ? "posture" : "posture/" + body->name;
    }
    const PostureMessage message =
        one.format->Format(*body, frame, std::chrono::steady_clock::now());
    constexpr auto kMore = zmq::send_flags::sndmore | zmq::send_flags::dontwait;
    try {
      socket_.send(zmq::buffer(one.topic), kMore);
      socket_.send(zmq::buffer(message.header), kMore);
      socket_.send(zmq::buffer(message.arrays), zmq::send_flags::dontwait);
    } catch (const zmq::error_t& error) {
      throw Error(fmt::format("{}: {}", name_, error.what()));
    }
  }

 private:
  std::string name_;
  zmq::context_t context_;
  zmq::socket_t socket_;
  std::optional<SubscriberGuard> guard_;
  struct Formatted {
    std::shared_ptr<const LiveBody> body;
    std::optional<PostureMessageFormat> format;
    std::string topic;
  };
  std::vector<Formatted> formats_;  // of each body of the stream
};

}  // namespace

std::unique_ptr<PoseSink> OpenZmqSink(const std::string& address) {
  return std::make_unique<ZmqSink>(address);
}

}  // namespace mmm_converter
