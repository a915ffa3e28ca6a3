// SPDX-License-Identifier: MIT
// QtmSource and servers that are not as they should be; QtmServer and what it may be asked.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <deque>

#include "common/live/qtm/qtm_server.h"
#include "common/live/qtm/qtm_source.h"
#include "common/support/error.h"
#include "tests/common/live/live_samples.h"

namespace mmm_converter {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::NextOf;
using testing::TestClock;
using ::testing::ThrowsMessage;

std::string Text(const std::string& text, QtmPacketType type = QtmPacketType::kCommand) {
  std::string packet;
  AppendQtmText(type, text, &packet);
  return packet;
}

std::string ErrorText(const std::string& text) { return Text(text, QtmPacketType::kError); }

std::string EventPacket(QtmEvent event) {
  std::string packet;
  AppendQtmEvent(event, &packet);
  return packet;
}

std::string Parameters(const std::vector<std::string>& labels,
                       const std::string& calibrated = "2020") {
  QtmParameters parameters;
  parameters.rate = 100;
  parameters.calibration_time = calibrated;
  parameters.labels = labels;
  return Text(FormatQtmParameters(parameters, {.general = true, .the_3d = true}, 25),
              QtmPacketType::kXml);
}

std::string Data(std::uint32_t number, std::size_t points) {
  QtmData data;
  data.frame = number;
  data.labelled.resize(points);
  std::string packet;
  AppendQtmData(data, {QtmComponent::k3d}, &packet);
  return packet;
}

/// Answers the n-th packet that comes with the n-th of its answers; the first is said unasked.
class ScriptedServer {
 public:
  explicit ScriptedServer(std::deque<std::string> answers)
      : answers_(std::move(answers)), listener_("127.0.0.1", 0) {}

  void Step(std::chrono::milliseconds) {
    TcpConnection connection;
    if (listener_.Accept(&connection)) {
      connection_.Use(std::move(connection));
      Say();
    }
    if (!connection_.tcp().is_open()) return;
    connection_.Receive();
    std::string_view packet;
    while (connection_.Take(&packet)) {
      asked_.emplace_back(QtmText(ParseQtmPacket(packet)));
      Say();
    }
    connection_.Flush();
  }

  void Send(const std::string& bytes) {
    *connection_.out() += bytes;
    connection_.Flush();
  }

  int port() const { return listener_.port(); }
  const std::vector<std::string>& asked() const { return asked_; }

 private:
  void Say() {
    if (answers_.empty()) return;
    *connection_.out() += answers_.front();
    answers_.pop_front();
  }

  std::deque<std::string> answers_;
  std::vector<std::string> asked_;
  TcpListener listener_;
  QtmConnection connection_;
};

const std::string kHello = Text("QTM RT Interface connected.");
const std::string kVersionSet = Text("Version set to 1.25");
const std::string kSoftware = Text("QTM Version is 2.3 (build 464)");

struct Pair {
  explicit Pair(std::deque<std::string> answers) : server(std::move(answers)), source(Options()) {}
  QtmSourceOptions Options() {
    QtmSourceOptions options;
    options.host = "127.0.0.1";
    options.port = server.port();
    options.now = clock.Now();
    return options;
  }
  StreamEvent Next() { return NextOf(&source, &server, &frame); }

  TestClock clock;
  ScriptedServer server;
  QtmSource source;
  StreamFrame frame;
};

TEST(QtmHostile, RefusalsAreErrorsThatSayWhatToDo) {
  const auto expect = [](std::deque<std::string> answers, const std::string& said) {
    Pair pair(std::move(answers));
    EXPECT_THAT([&] { pair.Next(); }, ThrowsMessage<Error>(HasSubstr(said))) << said;
  };
  expect({ErrorText("Connection refused. Max number of clients reached.")}, "end another program");
  expect({Text("SSH-2.0")}, "which QTM does not");
  expect({"HTTP/1.1 400 Bad Request\r\n\r\n"}, "no packet of QTM");
  std::deque<std::string> refusals = {kHello};
  for (int i = 0; i < 20; ++i) refusals.push_back(ErrorText("Version NOT supported"));
  expect(refusals, "none of the versions 1.25 to 1.8");
  expect({kHello, kVersionSet, kSoftware, ErrorText("Parameters not available")},
         "open a file or a new measurement");
  expect({kHello, kVersionSet, kSoftware, Parameters({})}, "no labelled markers");
  expect({kHello, kVersionSet, kSoftware, Parameters({"A"}, "")}, "calibrate it");
  expect({kHello, kVersionSet, kSoftware, Parameters(std::vector<std::string>(2001, "A"))},
         "at most 2000 are taken");
  expect({kHello, kVersionSet, kSoftware, Text("<QTM", QtmPacketType::kXml)}, "can't be read");
}

// Its first bytes say how large it is: no more is received.
TEST(QtmHostile, APacketThatIsTooLargeIsNotReceived) {
  std::string huge = Text(std::string(1000, 'x'));
  const std::uint32_t size = 400'000'000;
  std::memcpy(huge.data(), &size, sizeof size);
  Pair first({huge});
  EXPECT_THAT([&] { first.Next(); },
              ThrowsMessage<Error>(HasSubstr("a packet of 400000000 bytes")));
  Pair later({kHello, kVersionSet, kSoftware, Parameters({"A"}), Data(1, 1)});
  EXPECT_EQ(later.Next(), StreamEvent::kLayout);
  EXPECT_EQ(later.Next(), StreamEvent::kFrame);
  later.server.Send(huge);
  EXPECT_EQ(later.Next(), StreamEvent::kLost);
  EXPECT_EQ(later.source.counts().broken, 1);
}

TEST(QtmHostile, WhoDoesNotAnswerIsNotWaitedForForever) {
  Pair pair({kHello});
  EXPECT_EQ(pair.Next(), StreamEvent::kNothing);
  pair.clock.GoOn(6s);
  EXPECT_THAT([&] { pair.Next(); }, ThrowsMessage<Error>(HasSubstr("does not answer")));
}

TEST(QtmHostile, EventsBetweenACommandAndItsReply) {
  const std::string event = EventPacket(QtmEvent::kCaptureStarted);
  Pair pair({event + kHello, event + kVersionSet, event + kSoftware + event,
             event + Parameters({"A"}) + event, Data(1, 1)});
  EXPECT_EQ(pair.Next(), StreamEvent::kLayout);
  EXPECT_EQ(pair.source.layout().source, "QTM 2.3 (build 464), protocol 1.25");
  EXPECT_THAT(pair.server.asked()[0], "Version 1.25");
  EXPECT_THAT(pair.server.asked()[2], "GetParameters General 3D");
}

TEST(QtmHostile, WhichQtmItIsNeedNotBeSaid) {
  Pair pair({kHello, kVersionSet, "", Parameters({"A"})});
  EXPECT_EQ(pair.Next(), StreamEvent::kNothing);
  pair.clock.GoOn(2s);
  EXPECT_EQ(pair.Next(), StreamEvent::kLayout);
  EXPECT_EQ(pair.source.layout().source, "QTM, protocol 1.25");
}

TEST(QtmHostile, WithoutUnlabelledPointsWhereTheyAreRefused) {
  Pair pair(
      {kHello, kVersionSet, kSoftware, Parameters({"A"}), ErrorText("Parse error"), Data(5, 1)});
  EXPECT_EQ(pair.Next(), StreamEvent::kLayout);
  EXPECT_EQ(pair.Next(), StreamEvent::kFrame);
  EXPECT_THAT(pair.server.asked().back(), "StreamFrames AllFrames 3D");
}

TEST(QtmHostile, BrokenPacketsAreCountedAndLeftOut) {
  std::string cut = Data(2, 2);
  cut.resize(cut.size() - 4);
  cut[0] = static_cast<char>(cut.size());
  std::string unknown = Data(2, 2);
  unknown[4] = 99;
  Pair pair({kHello, kVersionSet, kSoftware, Parameters({"A", "B"}),
             Data(1, 2) + cut + unknown + Data(5, 2)});
  EXPECT_EQ(pair.Next(), StreamEvent::kLayout);
  EXPECT_EQ(pair.Next(), StreamEvent::kFrame);
  EXPECT_EQ(pair.Next(), StreamEvent::kFrame);
  EXPECT_EQ(pair.frame.number, 5);
  EXPECT_EQ(pair.source.counts().broken, 2);
  EXPECT_EQ(pair.source.counts().lost, 3);
}

TEST(QtmHostile, AnotherNumberOfPointsAsksForTheLabelsAgain) {
  Pair pair({kHello, kVersionSet, kSoftware, Parameters({"A"}), Data(1, 1),
             Parameters({"A", "B"}) + Data(3, 2)});
  EXPECT_EQ(pair.Next(), StreamEvent::kLayout);
  EXPECT_EQ(pair.Next(), StreamEvent::kFrame);
  pair.clock.GoOn(2s);
  pair.server.Send(Data(2, 2));
  EXPECT_EQ(pair.Next(), StreamEvent::kLayout);
  EXPECT_THAT(pair.source.layout().labels, ElementsAre("A", "B"));
  EXPECT_EQ(pair.Next(), StreamEvent::kFrame);
  EXPECT_EQ(pair.frame.points.cols(), 2);
}

TEST(QtmHostile, SilenceIsLossAndSaidOnce) {
  Pair pair({kHello, kVersionSet, kSoftware, Parameters({"A"}), Data(1, 1)});
  EXPECT_EQ(pair.Next(), StreamEvent::kLayout);
  EXPECT_EQ(pair.Next(), StreamEvent::kFrame);
  pair.clock.GoOn(4s);
  EXPECT_EQ(pair.Next(), StreamEvent::kNothing);
  pair.clock.GoOn(2s);
  EXPECT_EQ(pair.Next(), StreamEvent::kLost);
  EXPECT_THAT(pair.source.message(), HasSubstr("no labelled 3D data for 5 s"));
  pair.clock.GoOn(10s);
  EXPECT_EQ(pair.Next(), StreamEvent::kNothing);
}

TEST(QtmHostile, APauseIsNotAsked) {
  Pair pair({kHello, kVersionSet, kSoftware, Parameters({"A"}), Data(1, 1)});
  EXPECT_EQ(pair.Next(), StreamEvent::kLayout);
  EXPECT_EQ(pair.Next(), StreamEvent::kFrame);
  std::string no_more;
  AppendQtmPacket(QtmPacketType::kNoMoreData, "", &no_more);
  pair.server.Send(EventPacket(QtmEvent::kCaptureStopped) + no_more);
  EXPECT_EQ(pair.Next(), StreamEvent::kLost);
  EXPECT_THAT(pair.source.message(), HasSubstr("stopped the measurement"));
  pair.clock.GoOn(3600s);
  EXPECT_EQ(pair.Next(), StreamEvent::kNothing);
  const std::size_t asked = pair.server.asked().size();
  pair.server.Send(EventPacket(QtmEvent::kCaptureStarted) + Parameters({"A"}) + Data(1, 1));
  EXPECT_EQ(pair.Next(), StreamEvent::kLayout);
  EXPECT_EQ(pair.Next(), StreamEvent::kFrame);
  EXPECT_EQ(pair.source.counts().connections, 1);
  pair.Next();
  EXPECT_EQ(pair.server.asked().size(), asked + 2);  // parameters, stream
}

/// A client that says what it likes.
class RawClient {
 public:
  explicit RawClient(QtmServer* server) : server_(server) {
    connection_.Use(TcpConnection::To("127.0.0.1", server->port()));
  }

  /// The next packet; empty: none, or the connection is closed.
  std::string Next() {
    std::string_view packet;
    for (int i = 0; i < 200; ++i) {
      if (connection_.Take(&packet)) return std::string(packet);
      server_->Step(0ms);
      connection_.Receive();
    }
    return "";
  }

  std::string Ask(const std::string& command) {
    connection_.SendCommand(command);
    const std::string answer = Next();
    if (answer.empty()) return "nothing";
    const QtmPacket packet = ParseQtmPacket(answer);
    const bool has_text = packet.type <= QtmPacketType::kXml;
    return fmt::format("{} {}", static_cast<int>(packet.type), has_text ? QtmText(packet) : "");
  }

  void Send(const std::string& bytes) {
    *connection_.out() += bytes;
    connection_.Flush();
  }

 private:
  QtmServer* server_;
  QtmConnection connection_;
};

QtmServerOptions Quick() {
  QtmServerOptions options;
  options.port = 0;
  options.playback.speed = 0;
  options.most_clients = 2;
  return options;
}

TEST(QtmServer, Commands) {
  QtmServer server(testing::SampleRecording(), Quick());
  RawClient client(&server);
  EXPECT_EQ(client.Next(), Text("QTM RT Interface connected"));
  EXPECT_THAT(client.Ask("StreamFrames AllFrames 3D"), HasSubstr("0 Set a version"));
  EXPECT_EQ(client.Ask("version 1.7"), "0 Version NOT supported");
  EXPECT_EQ(client.Ask("version 2.0"), "0 Version NOT supported");
  EXPECT_EQ(client.Ask("vErSiOn 1.28"), "1 Version set to 1.28");
  EXPECT_EQ(client.Ask("byteorder"), "1 Byte order is little endian");
  EXPECT_THAT(client.Ask("QTMVersion"), HasSubstr("1 QTM Version is "));
  EXPECT_EQ(client.Ask("GetState"), "6 ");
  EXPECT_THAT(client.Ask("getparameters all"), HasSubstr("<The_6D>"));
  EXPECT_THAT(client.Ask("GetParameters Skeleton:global 3D"), HasSubstr("<Name>C c</Name>"));
  EXPECT_EQ(client.Ask("GetParameters Everything"), "0 Parse error");
  EXPECT_EQ(client.Ask("Nonsense"), "0 Parse error");
  EXPECT_EQ(client.Ask(""), "0 Parse error");
  EXPECT_THAT(client.Ask("TakeControl secret"), HasSubstr("0 This server plays"));
  EXPECT_EQ(client.Ask("StreamFrames Often 3D"), "0 Parse error");
  EXPECT_EQ(client.Ask("StreamFrames AllFrames UDP:80 3D"), "0 Parse error");
  EXPECT_EQ(client.Ask("StreamFrames AllFrames 4D"), "0 Parse error");
  EXPECT_EQ(client.Ask("GetCurrentFrame 3Dres 6D analog:1,2 timecode"), "3 ");
  EXPECT_EQ(client.Ask("StreamFrames FrequencyDivisor:3 3DNoLabels 3D"), "3 ");
}

TEST(QtmServer, DivisorAndFrequencyChooseFrames) {
  const auto numbers = [](const std::string& command) {
    QtmServer server(testing::SampleRecording(), Quick());
    RawClient client(&server);
    client.Next();
    client.Ask("Version 1.25");
    std::vector<int> frames;
    QtmData data;
    client.Send(Text(command));
    for (std::string packet = client.Next(); !packet.empty(); packet = client.Next()) {
      if (ParseQtmPacket(packet).type != QtmPacketType::kData) continue;
      ParseQtmData(ParseQtmPacket(packet).body, &data);
      frames.push_back(static_cast<int>(data.frame));
    }
    return frames;
  };
  EXPECT_THAT(numbers("StreamFrames FrequencyDivisor:3 3D"), ElementsAre(1, 4, 7));
  EXPECT_THAT(numbers("StreamFrames Frequency:60 3D"), ElementsAre(1, 3, 5, 7));
  EXPECT_THAT(numbers("StreamFrames Frequency:500 3D"), ::testing::SizeIs(8));
}

TEST(QtmServer, ClientsBeyondTheLastAreSentAway) {
  QtmServer server(testing::SampleRecording(), Quick());
  RawClient first(&server), second(&server), third(&server);
  first.Next();
  second.Next();
  EXPECT_THAT(third.Next(), HasSubstr("Max number of clients"));
  EXPECT_EQ(server.num_clients(), 2U);
}

TEST(QtmServer, WhatIsNoPacketEndsTheConnection) {
  QtmServer server(testing::SampleRecording(), Quick());
  RawClient client(&server);
  client.Next();
  client.Send(std::string("GET / HTTP/1.1\r\n\r\n"));
  EXPECT_EQ(client.Next(), "");
  EXPECT_EQ(server.num_clients(), 0U);
}

// Small questions with large answers: what waits for who does not take them is bounded.
TEST(QtmServer, WhoAsksAndDoesNotTakeTheAnswersIsSentAway) {
  std::vector<std::string> labels;
  for (int i = 0; i < 20000; ++i) labels.push_back(fmt::format("marker {}", i));
  QtmServer server(testing::SampleRecording(labels, 1), Quick());
  RawClient client(&server);
  client.Next();
  client.Ask("Version 1.25");
  std::string questions;
  for (int i = 0; i < 1000; ++i) questions += Text("GetParameters 3D");
  client.Send(questions);
  for (int i = 0; i < 100 && server.num_clients() > 0; ++i) server.Step(0ms);
  EXPECT_EQ(server.num_clients(), 0U);
}

TEST(QtmServer, APortThatIsTaken) {
  QtmServer server(testing::SampleRecording(), Quick());
  QtmServerOptions options = Quick();
  options.port = server.port();
  EXPECT_THAT([&] { QtmServer(testing::SampleRecording(), options); },
              ThrowsMessage<Error>(HasSubstr("choose another port")));
}

}  // namespace
}  // namespace mmm_converter
