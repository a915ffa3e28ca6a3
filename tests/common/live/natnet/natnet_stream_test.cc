// SPDX-License-Identifier: MIT
// NatNetSource and NatNetServer together.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <list>

#include "common/live/natnet/natnet_layout.h"
#include "common/live/natnet/natnet_server.h"
#include "common/live/natnet/natnet_source.h"
#include "common/live/source_address.h"
#include "common/live/wire/byte_reader.h"
#include "common/support/error.h"
#include "tests/common/live/live_samples.h"
#include "tests/common/live/natnet/natnet_samples.h"

namespace mmm_converter::testing {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

int FreeUdpPort() { return UdpSocket("127.0.0.1", 0).port(); }

NatNetServerOptions FastNatNet(const NatNetVersion& version = {4, 1}, const TestClock& clock = {}) {
  NatNetServerOptions options;
  options.command_port = 0;
  options.data_port = FreeUdpPort();
  options.version = version;
  options.playback = {.speed = 0, .loop = false, .now = clock.Now()};
  return options;
}

NatNetSourceOptions To(const NatNetServer& server, const TestClock& clock = {}) {
  NatNetSourceOptions options;
  options.host = "127.0.0.1";
  options.command_port = server.command_port();
  options.data_port = FreeUdpPort();
  options.now = clock.Now();
  return options;
}

TEST(NatNetStream, EveryVersion) {
  for (const NatNetVersion& version : kNatNetVersions) {
    NatNetServer server(SampleRecording(), FastNatNet(version));
    NatNetSource source(To(server));
    StreamFrame frame;
    ASSERT_EQ(NextOf(&source, &server, &frame), StreamEvent::kLayout) << Format(version);
    EXPECT_EQ(source.layout().source, "MMMConverterS2KF 1.0, NatNet " + Format(version));
    EXPECT_EQ(source.layout().rate, 120);
    EXPECT_THAT(source.layout().labels, ElementsAre("A", "B", "C c"));
    // Frames come before the model is known, and are not taken then.
    for (std::int64_t number = 0; number < 8; number = frame.number) {
      ASSERT_EQ(NextOf(&source, &server, &frame), StreamEvent::kFrame);
      ExpectFrame(frame, SampleRecording(), static_cast<int>(frame.number - 1));
      EXPECT_NEAR(frame.time,
                  static_cast<double>(frame.number - (version < NatNetVersion{2, 6} ? 0 : 1)) / 120,
                  1e-6);
      EXPECT_EQ(frame.unnamed, 0);
    }
    EXPECT_EQ(source.counts().broken, 0);
    EXPECT_EQ(source.counts().lost, 0);
  }
}

TEST(NatNetStream, PointsWithoutLabels) {
  const MarkerSequence recording = SampleRecording({"A", "*7", "C", "*9"});
  for (const NatNetVersion& version : kNatNetVersions) {
    SCOPED_TRACE(Format(version));
    NatNetServer server(recording, FastNatNet(version));
    NatNetSource source(To(server));
    ExpectUnlabelled(&source, &server, recording, {"A", "C"});
  }
}

TEST(NatNetStream, NoLabelsAtAll) {
  const MarkerSequence recording = SampleRecording({"*1", "*2", "*3"});
  {
    NatNetServer server(recording, FastNatNet());
    NatNetSource source(To(server));
    StreamFrame frame;
    EXPECT_THAT([&] { NextOf(&source, &server, &frame); },
                ThrowsMessage<Error>(HasSubstr("named by the body")));
  }
  NatNetServer server(recording, FastNatNet());
  const auto source = OpenSource(
      fmt::format("natnet://127.0.0.1:{}?data={}", server.command_port(), FreeUdpPort()), false);
  ExpectUnlabelled(source.get(), &server, recording, {});
}

TEST(NatNetStream, ZUpWhereItIsSaid) {
  NatNetServerOptions options = FastNatNet();
  options.up_axis = UpAxis::kZ;
  NatNetServer server(SampleRecording(), options);
  const auto source = OpenSource(
      fmt::format("natnet://127.0.0.1:{}?up=z&data={}", server.command_port(), FreeUdpPort()));
  StreamFrame frame;
  NextOf(source.get(), &server, &frame);
  ASSERT_EQ(NextOf(source.get(), &server, &frame), StreamEvent::kFrame);
  ExpectFrame(frame, SampleRecording(), static_cast<int>(frame.number - 1));
}

TEST(NatNetStream, TwoClients) {
  NatNetServerOptions options = FastNatNet();
  options.playback.loop = true;
  NatNetServer server(SampleRecording(), options);
  NatNetSource first(To(server)), second(To(server));
  ExpectLoopForTwo(&first, &second, &server, SampleRecording());
}

TEST(NatNetStream, Multicast) {
  NatNetServerOptions options = FastNatNet({3, 0});
  options.group = "239.255.42.98";
  options.playback.loop = true;
  NatNetServer server(SampleRecording(), options);
  NatNetSourceOptions to = To(server);
  to.data_port.reset();
  NatNetSource source(to);
  StreamFrame frame;
  ASSERT_EQ(NextOf(&source, &server, &frame), StreamEvent::kLayout);
  if (NextOf(&source, &server, &frame) != StreamEvent::kFrame) {
    GTEST_SKIP() << "no multicast over the loopback interface here";
  }
  ExpectFrame(frame, SampleRecording(), static_cast<int>((frame.number - 1) % 8));
  EXPECT_EQ(server.num_clients(), 0U);
}

TEST(NatNetStream, OtherMarkersOnTheFly) {
  TestClock clock;
  NatNetServerOptions options = FastNatNet({3, 1}, clock);
  options.playback.loop = true;
  NatNetServer server(SampleRecording(), options);
  NatNetSource source(To(server, clock));
  ExpectReplaced(&source, &server, SampleRecording({"D", "A"}));
}

TEST(NatNetStream, CutAndResumed) {
  TestClock clock;
  auto server = std::make_unique<NatNetServer>(SampleRecording(), FastNatNet());
  NatNetSource source(To(*server, clock));
  StreamFrame frame;
  NextOf(&source, server.get(), &frame);
  ASSERT_EQ(NextOf(&source, server.get(), &frame), StreamEvent::kFrame);
  NatNetServerOptions same_port = FastNatNet();
  same_port.command_port = server->command_port();
  server.reset();
  StreamEvent event = StreamEvent::kFrame;
  while (event == StreamEvent::kFrame) event = source.Next(100ms, &frame);
  EXPECT_EQ(event, StreamEvent::kLost);
  EXPECT_THAT(source.message(), HasSubstr("ended the connection"));
  for (int i = 0; i < 10; ++i) {
    clock.GoOn(4s);
    EXPECT_EQ(source.Next(0ms, &frame), StreamEvent::kNothing);
  }
  server = std::make_unique<NatNetServer>(SampleRecording(), same_port);
  event = StreamEvent::kNothing;
  for (int i = 0; i < 40 && event == StreamEvent::kNothing; ++i) {
    clock.GoOn(600ms);
    server->Step(0ms);
    event = source.Next(0ms, &frame);
  }
  EXPECT_EQ(event, StreamEvent::kLayout);
  EXPECT_EQ(NextOf(&source, server.get(), &frame), StreamEvent::kFrame);
  EXPECT_EQ(source.counts().connections, 2);
}

TEST(NatNetStream, SilenceIsLossAndBrokenMessagesAreCounted) {
  TestClock clock;
  NatNetServer server(SampleRecording(), FastNatNet());
  NatNetSourceOptions options = To(server, clock);
  NatNetSource source(options);
  StreamFrame frame;
  NextOf(&source, &server, &frame);
  while (NextOf(&source, &server, &frame) == StreamEvent::kFrame) continue;
  UdpSocket other("127.0.0.1", 0);
  for (const char* bytes : {"a", "\7\0\0\0", "\5\0\4\0\xFF\xFF\xFF\x7F"}) {
    other.Send(std::string_view(bytes, bytes[0] == 'a' ? 1
                                       : bytes[0] == 7 ? 4
                                                       : 8),
               FindUdpAddress("127.0.0.1", *options.data_port));
  }
  EXPECT_EQ(NextOf(&source, &server, &frame), StreamEvent::kNothing);
  EXPECT_EQ(source.counts().broken, 3);
  clock.GoOn(6s);
  EXPECT_EQ(NextOf(&source, &server, &frame), StreamEvent::kLost);
  EXPECT_THAT(source.message(), HasSubstr("no frames"));
}

// Datagrams of somebody else between those of the server: all frames come all the same.
TEST(NatNetStream, AFloodOfNonsense) {
  TestClock clock;
  NatNetServer server(SampleRecording(), FastNatNet());
  const NatNetSourceOptions options = To(server, clock);
  NatNetSource source(options);
  StreamFrame frame;
  EXPECT_EQ(NextOf(&source, &server, &frame), StreamEvent::kLayout);
  UdpSocket other("127.0.0.1", 0);
  const UdpAddress data = FindUdpAddress("127.0.0.1", *options.data_port);
  const std::string nonsense = FormatNatNetMessage(NatNetId::kFrame, std::string(1000, '\xFF'));
  // As long as one can be, with lists of 2^24 elements each; the server gets it, too.
  const std::string largest =
      FormatNatNetMessage(NatNetId::kFrame, std::string(kMostNatNetBytes - 4, '\1'));
  std::int64_t frames = 0;
  for (bool is_there = true; is_there; ++frames) {
    for (int i = 0; i < 150; ++i) other.Send(nonsense, data);
    EXPECT_TRUE(other.Send(largest, data));
    other.Send(largest, FindUdpAddress("127.0.0.1", server.command_port()));
    is_there = NextOf(&source, &server, &frame) == StreamEvent::kFrame;
  }
  EXPECT_EQ(frame.number, SampleRecording().num_frames());
  EXPECT_EQ(source.counts().lost, 0);
  EXPECT_EQ(source.counts().broken, 151 * frames);
}

TEST(NatNetStream, NobodyThere) {
  TestClock clock;
  NatNetSourceOptions options;
  options.host = "127.0.0.1";
  options.command_port = FreeUdpPort();
  options.now = clock.Now();
  NatNetSource source(options);
  StreamFrame frame;
  EXPECT_EQ(source.Next(0ms, &frame), StreamEvent::kNothing);
  clock.GoOn(4s);
  EXPECT_THAT([&] { source.Next(0ms, &frame); },
              ThrowsMessage<Error>(AllOf(HasSubstr("no answer"), HasSubstr("start Motive"))));
}

/// A client that says what it likes.
class RawNatNetClient {
 public:
  explicit RawNatNetClient(NatNetServer* server)
      : server_(server), address_(FindUdpAddress("127.0.0.1", server->command_port())) {}

  void Send(NatNetId id, std::string_view payload) {
    socket_.Send(FormatNatNetMessage(id, payload), address_);
  }

  /// The next message that is no frame; empty: none.
  std::string Next() {
    UdpAddress sender;
    for (int i = 0; i < 200; ++i) {
      server_->Step(0ms);
      const auto datagram = socket_.Receive(&sender);
      if (datagram && ParseNatNetMessage(*datagram).id != NatNetId::kFrame) {
        return std::string(*datagram);
      }
    }
    return "";
  }

  std::string Ask(NatNetId id, std::string_view payload = {}) {
    Send(id, payload);
    return Next();
  }

 private:
  NatNetServer* server_;
  UdpAddress address_;
  UdpSocket socket_{"127.0.0.1", 0};
};

NatNetVersion VersionIn(const std::string& message) {
  return ParseNatNetServerInfo(ParseNatNetMessage(message).payload).version;
}

TEST(NatNetServer, Messages) {
  TestClock clock;
  NatNetServer server(SampleRecording(), FastNatNet({4, 1}, clock));
  RawNatNetClient client(&server);
  EXPECT_EQ(VersionIn(client.Ask(NatNetId::kDiscovery)), (NatNetVersion{4, 1}));
  EXPECT_EQ(server.num_clients(), 0U);
  EXPECT_EQ(VersionIn(client.Ask(NatNetId::kConnect, "Ping")), (NatNetVersion{4, 1}));
  EXPECT_EQ(server.num_clients(), 1U);
  const std::string echo = client.Ask(NatNetId::kEchoRequest, "12345678");
  EXPECT_EQ(echo.substr(0, 12), std::string("\xD\0\x10\0"
                                            "12345678",
                                            12));
  EXPECT_EQ(client.Ask(NatNetId::kRequest, "FrameRate"), std::string("\3\0\4\0\0\0\xF0\x42", 8));
  EXPECT_EQ(client.Ask(NatNetId::kRequest, "Dance"), std::string("\x64\0\0\0", 4));
  EXPECT_EQ(client.Ask(NatNetId::kRequest, "Bitstream,9.9"), "");
  EXPECT_EQ(client.Ask(NatNetId::kRequest, "Bitstream,4.0"), std::string("\3\0\4\0\0\0\0\0", 8));
  EXPECT_EQ(VersionIn(client.Ask(NatNetId::kConnect)), (NatNetVersion{4, 0}));
  const std::string model = client.Ask(NatNetId::kRequestModel);
  EXPECT_EQ(ParseNatNetModel(ParseNatNetMessage(model).payload, {4, 0}).skeletons.size(), 1U);
  clock.GoOn(9s);
  client.Ask(NatNetId::kKeepAlive);
  clock.GoOn(9s);
  server.Step(0ms);
  EXPECT_EQ(server.num_clients(), 1U);
  clock.GoOn(2s);
  EXPECT_EQ(client.Next(), std::string("\xB\0\0\0", 4));
  EXPECT_EQ(server.num_clients(), 0U);
}

TEST(NatNetServer, ClientsAreLimited) {
  NatNetServer server(SampleRecording(), FastNatNet());
  std::list<RawNatNetClient> clients;
  for (int i = 0; i < 40; ++i) {
    EXPECT_NE(clients.emplace_back(&server).Ask(NatNetId::kConnect), "");
  }
  EXPECT_EQ(server.num_clients(), 32U);
}

TEST(NatNetServer, TheVersionThatAClientConnectsWith) {
  NatNetServer server(SampleRecording(), FastNatNet());
  RawNatNetClient client(&server);
  EXPECT_EQ(VersionIn(client.Ask(NatNetId::kConnect, FormatNatNetConnect("x", {4, 0}))),
            (NatNetVersion{4, 0}));
}

TEST(NatNetServer, MoreMarkersThanADatagramHolds) {
  const std::vector<std::string> labels(4000, "a");
  EXPECT_THAT([&] { NatNetServer(MarkerSequence(labels, 1, 100, 0), FastNatNet()); },
              ThrowsMessage<Error>(HasSubstr("no room in a datagram")));
}

}  // namespace
}  // namespace mmm_converter::testing
