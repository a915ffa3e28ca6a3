// SPDX-License-Identifier: MIT
// QtmSource and QtmServer together.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/live/qtm/qtm_server.h"
#include "common/live/qtm/qtm_source.h"
#include "common/live/source_address.h"
#include "common/support/error.h"
#include "tests/common/live/live_samples.h"

namespace mmm_converter::testing {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

QtmServerOptions FastQtm() {
  QtmServerOptions options;
  options.port = 0;
  options.playback.speed = 0;
  return options;
}

QtmSourceOptions To(const QtmServer& server, const TestClock& clock = {}) {
  QtmSourceOptions options;
  options.host = "localhost";
  options.port = server.port();
  options.now = clock.Now();
  return options;
}

TEST(QtmStream, EveryVersion) {
  const MarkerSequence recording = SampleRecording();
  for (int minor = kOldestQtmMinor; minor <= kNewestQtmMinor; ++minor) {
    QtmServer server(recording, FastQtm());
    QtmSourceOptions options = To(server);
    options.newest_minor = minor;
    QtmSource source(options);
    ExpectRecording(&source, &server, recording);
    EXPECT_THAT(source.layout().source, HasSubstr(fmt::format("protocol 1.{}", minor)));
    StreamFrame frame;
    EXPECT_EQ(NextOf(&source, &server, &frame), StreamEvent::kLost);
    EXPECT_THAT(source.message(), HasSubstr("stopped playing"));
  }
}

TEST(QtmStream, TheNewestVersionOfBoth) {
  QtmServerOptions options = FastQtm();
  options.newest_minor = 19;
  QtmServer server(SampleRecording(), options);
  QtmSource source(To(server));
  StreamFrame frame;
  EXPECT_EQ(NextOf(&source, &server, &frame), StreamEvent::kLayout);
  EXPECT_EQ(source.layout().source, "QTM 2.3 (build 0, MMMConverterS2KF), protocol 1.19");
}

TEST(QtmStream, LabsOfAllAxes) {
  for (int axis = 0; axis < 6; ++axis) {
    QtmServerOptions options = FastQtm();
    options.up_axis = static_cast<UpAxis>(axis);
    QtmServer server(SampleRecording(), options);
    QtmSource source(To(server));
    ExpectRecording(&source, &server, SampleRecording());
  }
}

TEST(QtmStream, ByUdp) {
  QtmServer server(SampleRecording(), FastQtm());
  const auto source =
      OpenSource(fmt::format("qtm://127.0.0.1:{}?udp=yes&version=1.22", server.port()));
  ExpectRecording(source.get(), &server, SampleRecording());
  EXPECT_THAT(source->layout().source, HasSubstr("protocol 1.22"));
}

TEST(QtmStream, PointsWithoutLabels) {
  // The second point is not seen in a frame.
  const MarkerSequence recording = SampleRecording({"A", "*7", "C", "*9"});
  QtmServer server(recording, FastQtm());
  QtmSource source(To(server));
  ExpectUnlabelled(&source, &server, recording, {"A", "C"});
}

TEST(QtmStream, NoLabelsAtAll) {
  const MarkerSequence recording = SampleRecording({"*1", "*2", "*3"});
  {
    QtmServer server(recording, FastQtm());
    QtmSource source(To(server));
    StreamFrame frame;
    EXPECT_THAT([&] { NextOf(&source, &server, &frame); },
                ThrowsMessage<Error>(HasSubstr("named by the body")));
  }
  QtmServer server(recording, FastQtm());
  const auto source = OpenSource(fmt::format("qtm://127.0.0.1:{}", server.port()), false);
  ExpectUnlabelled(source.get(), &server, recording, {});
}

TEST(QtmStream, TimesAreOfTheFrameNumbers) {
  QtmServer server(SampleRecording(), FastQtm());
  QtmSource source(To(server));
  StreamFrame frame;
  NextOf(&source, &server, &frame);
  NextOf(&source, &server, &frame);
  EXPECT_DOUBLE_EQ(frame.time, 1 / 120.0);
  NextOf(&source, &server, &frame);
  EXPECT_DOUBLE_EQ(frame.time, 2 / 120.0);
}

TEST(QtmStream, TwoClientsAndALoop) {
  QtmServerOptions options = FastQtm();
  options.playback.loop = true;
  QtmServer server(SampleRecording(), options);
  QtmSource first(To(server)), second(To(server));
  ExpectLoopForTwo(&first, &second, &server, SampleRecording());
}

TEST(QtmStream, InTheRecordingsTime) {
  const TestClock clock;
  QtmServerOptions options = FastQtm();
  options.playback = {.speed = 2, .now = clock.Now()};
  QtmServer server(SampleRecording(), options);
  QtmSource source(To(server));
  StreamFrame frame;
  EXPECT_EQ(NextOf(&source, &server, &frame), StreamEvent::kLayout);
  EXPECT_EQ(NextOf(&source, &server, &frame), StreamEvent::kFrame);
  EXPECT_EQ(NextOf(&source, &server, &frame), StreamEvent::kNothing);
  TestClock(clock).GoOn(9ms);  // two frames of 1/240 s
  EXPECT_EQ(NextOf(&source, &server, &frame), StreamEvent::kFrame);
  EXPECT_EQ(NextOf(&source, &server, &frame), StreamEvent::kFrame);
  EXPECT_EQ(NextOf(&source, &server, &frame), StreamEvent::kNothing);
  EXPECT_EQ(frame.number, 3);
}

TEST(QtmStream, OtherLabelsOnTheFly) {
  QtmServerOptions options = FastQtm();
  options.playback.loop = true;
  QtmServer server(SampleRecording(), options);
  QtmSource source(To(server));
  ExpectReplaced(&source, &server, SampleRecording({"C c", "B", "A", "D"}));
}

TEST(QtmStream, PlayedAgainForTheNextClient) {
  QtmServer server(SampleRecording(), FastQtm());
  QtmSource first(To(server));
  ExpectRecording(&first, &server, SampleRecording());
  StreamFrame frame;
  EXPECT_EQ(NextOf(&first, &server, &frame), StreamEvent::kLost);
  QtmSource second(To(server));
  EXPECT_EQ(NextOf(&second, &server, &frame), StreamEvent::kLayout);
  EXPECT_EQ(NextOf(&second, &server, &frame), StreamEvent::kFrame);
  EXPECT_GE(frame.number, 9);
  EXPECT_EQ(NextOf(&first, &server, &frame), StreamEvent::kLayout);
  EXPECT_EQ(NextOf(&first, &server, &frame), StreamEvent::kFrame);
}

TEST(QtmStream, CutAndResumed) {
  TestClock clock;
  auto server = std::make_unique<QtmServer>(SampleRecording(), FastQtm());
  QtmSource source(To(*server, clock));
  StreamFrame frame;
  NextOf(&source, server.get(), &frame);
  ASSERT_EQ(NextOf(&source, server.get(), &frame), StreamEvent::kFrame);
  QtmServerOptions same_port = FastQtm();
  same_port.port = server->port();
  server.reset();
  EXPECT_EQ(source.Next(100ms, &frame), StreamEvent::kLost);
  EXPECT_THAT(source.message(), HasSubstr("shutting down"));
  for (int i = 0; i < 5; ++i) {  // nobody is there; that is not said again
    clock.GoOn(9s);
    EXPECT_EQ(source.Next(0ms, &frame), StreamEvent::kNothing);
  }
  server = std::make_unique<QtmServer>(SampleRecording(), same_port);
  clock.GoOn(9s);
  EXPECT_EQ(NextOf(&source, server.get(), &frame), StreamEvent::kLayout);
  EXPECT_EQ(NextOf(&source, server.get(), &frame), StreamEvent::kFrame);
  EXPECT_EQ(source.counts().connections, 2);
  EXPECT_EQ(source.counts().lost, 0);
}

TEST(QtmStream, Discovered) {
  TestClock clock;
  QtmServerOptions options = FastQtm();
  options.discovery_port = 0;
  QtmServer server(SampleRecording(), options);
  QtmSourceOptions anybody;
  anybody.discovery_port = server.discovery_port();
  anybody.now = clock.Now();
  QtmSource source(anybody);
  StreamFrame frame;
  EXPECT_EQ(NextOf(&source, &server, &frame), StreamEvent::kNothing);
  clock.GoOn(2s);
  EXPECT_EQ(NextOf(&source, &server, &frame), StreamEvent::kLayout);
  EXPECT_EQ(NextOf(&source, &server, &frame), StreamEvent::kFrame);
}

TEST(QtmStream, NobodyThere) {
  int port = 0;
  {
    const TcpListener closed_soon("127.0.0.1", 0);
    port = closed_soon.port();
  }
  StreamFrame frame;
  const auto source = OpenSource(fmt::format("qtm://127.0.0.1:{}", port));
  EXPECT_THAT([&] { source->Next(1000ms, &frame); },
              ThrowsMessage<Error>(AllOf(HasSubstr(std::to_string(port)), HasSubstr("refused"),
                                         HasSubstr("start QTM there"))));
}

TEST(SourceAddress, WhatIsNotUnderstood) {
  const auto expect = [](const std::string& address, const std::string& said) {
    EXPECT_THAT([&] { OpenSource(address); }, ThrowsMessage<Error>(HasSubstr(said))) << address;
  };
  expect("192.168.1.10", "is no source of frames");
  expect("vicon://host", "qtm://HOST[:PORT]");
  expect("qtm://host:0", "port");
  expect("qtm://host:70000", "port");
  expect("qtm://[::1", "closing");
  expect("qtm://host?udp=maybe", "yes or no");
  expect("qtm://host?up=z", "unknown option \"up\"");
  expect("qtm://host?version=1.7", "1.8 to 1.28");
  expect("natnet://host?up=left", "unknown up axis");
  expect("natnet://host?multicas=1", "unknown option");
}

}  // namespace
}  // namespace mmm_converter::testing
