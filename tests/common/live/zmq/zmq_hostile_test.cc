// SPDX-License-Identifier: MIT
// ZmqSink and subscribers that are not as they should be.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <vector>
#include <zmq.hpp>

#include "common/live/zmq/subscriber_guard.h"
#include "common/live/zmq/zmq_sink.h"
#include "tests/common/convert/fake_converter.h"
#include "tests/common/live/zmq/small_body.h"

namespace mmm_converter {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using namespace std::string_literals;

// A frame of the ZeroMQ message transport protocol 3.0: "\0" of a short message, its size.
std::string ShortFrame(const std::string& text) {
  return "\0"s + static_cast<char>(text.size()) + text;
}

class RawSubscriber {
 public:
  explicit RawSubscriber(int port) {
    socket_.connect({asio::ip::make_address("127.0.0.1"), static_cast<unsigned short>(port)});
  }

  // Greets, and is a subscriber afterwards.
  void BeSubscriber() {
    const std::string greeting = "\xFF\0\0\0\0\0\0\0\0\x7F\x03\0NULL"s + std::string(48, '\0');
    const std::string ready = "\x04\x19\x05READY\x0BSocket-Type\0\0\0\x03SUB"s;
    Send(greeting + ready);
    std::string answer(greeting.size() + ready.size(), '\0');
    asio::read(socket_, asio::buffer(answer), failure_);
    EXPECT_FALSE(failure_) << failure_.message();
  }
  // false: the connection has ended.
  bool Send(const std::string& bytes) {
    asio::write(socket_, asio::buffer(bytes), failure_);
    return !failure_;
  }
  // Reads on until the other side ends the connection.
  bool IsEnded() {
    std::array<char, 4096> bytes{};
    while (!failure_) socket_.read_some(asio::buffer(bytes), failure_);
    return failure_ == asio::error::eof || failure_ == asio::error::connection_reset ||
           failure_ == asio::error::broken_pipe;
  }

 private:
  asio::io_context context_;
  tcp::socket socket_{context_};
  boost::system::error_code failure_;
};

class ZmqHostile : public ::testing::Test {
 protected:
  // Whether a subscriber gets postures. A publisher says nothing to who has not subscribed yet.
  bool IsServed(zmq::socket_t* subscriber) {
    zmq::message_t part;
    while (subscriber->recv(part, zmq::recv_flags::dontwait)) continue;
    for (int tries = 0; tries < 500; ++tries) {
      sink_->Write(body_, frame_);
      if (subscriber->recv(part)) return true;
    }
    return false;
  }
  zmq::socket_t Subscriber() {
    zmq::socket_t subscriber(context_, zmq::socket_type::sub);
    subscriber.set(zmq::sockopt::subscribe, "posture");
    subscriber.set(zmq::sockopt::rcvtimeo, 20);
    subscriber.connect(fmt::format("tcp://127.0.0.1:{}", port_));
    return subscriber;
  }
  void Write() { sink_->Write(body_, frame_); }

  const int port_ = testing::FreePort();
  const std::shared_ptr<const LiveBody> body_ = testing::SmallBody();
  const PoseFrame frame_ = testing::SmallFrame(*body_);
  std::unique_ptr<PoseSink> sink_ = OpenZmqSink(fmt::format("zmq://127.0.0.1:{}", port_));
  zmq::context_t context_;
};

// 400 MB of a topic are announced: the connection ends before they are received.
TEST_F(ZmqHostile, ATopicWithoutEndIsNotReceived) {
  zmq::socket_t subscriber = Subscriber();
  EXPECT_TRUE(IsServed(&subscriber));
  RawSubscriber hostile(port_);
  hostile.BeSubscriber();
  hostile.Send("\x02\0\0\0\0\x17\xD7\x84\0\x01"s);
  const std::string part(1 << 20, 'x');
  int sent = 0;
  while (sent < 400 && hostile.Send(part)) ++sent;
  EXPECT_LT(sent, 64);
  EXPECT_TRUE(hostile.IsEnded());
  EXPECT_TRUE(IsServed(&subscriber));
}

TEST_F(ZmqHostile, SubscriptionsAreLimited) {
  zmq::socket_t subscriber = Subscriber();
  RawSubscriber hostile(port_);
  hostile.BeSubscriber();
  constexpr int kMost = 4'000'000;
  int sent = 0;
  for (bool is_taken = true; is_taken && sent < kMost; Write()) {
    std::string some;
    for (int i = 0; i < 1000; ++i) some += ShortFrame(fmt::format("\x01topic {}", sent++));
    is_taken = hostile.Send(some);
  }
  EXPECT_LT(sent, kMost);
  EXPECT_TRUE(hostile.IsEnded());
  EXPECT_TRUE(IsServed(&subscriber));
}

TEST_F(ZmqHostile, SubscribersAreLimited) {
  zmq::socket_t subscriber = Subscriber();
  EXPECT_TRUE(IsServed(&subscriber));
  std::vector<std::unique_ptr<RawSubscriber>> others;
  for (int i = 1; i < SubscriberGuard::kMostSubscribers; ++i) {
    others.push_back(std::make_unique<RawSubscriber>(port_));
    others.back()->BeSubscriber();
  }
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(RawSubscriber(port_).IsEnded());
  EXPECT_TRUE(others.back()->Send(ShortFrame("\x01posture")));
  EXPECT_TRUE(IsServed(&subscriber));
  // Who goes makes room.
  others.clear();
  zmq::socket_t late = Subscriber();
  EXPECT_TRUE(IsServed(&late));
}

}  // namespace
}  // namespace mmm_converter
