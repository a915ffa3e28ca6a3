// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <memory>
#include <thread>

#include "common/io/recording/recording.h"
#include "common/live/net/udp_socket.h"
#include "common/live/source_address.h"
#include "tests/cli/program.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using testing::Handstand;
using ::testing::HasSubstr;
using testing::RunProgram;
using testing::StartedProgram;

/// What the program says that clients connect to; waits until it has said it.
std::string AddressOf(const StartedProgram& program) {
  std::string said;
  while (said.find("Ctrl-C") == std::string::npos && said.find("error") == std::string::npos) {
    std::this_thread::yield();
    said = program.Said();
  }
  const std::string before = "connect to ";
  const std::size_t begin = said.find(before);
  if (begin == std::string::npos) return said;
  return said.substr(begin + before.size(), said.find(';', begin) - begin - before.size());
}

/// Frames of the handstand, its first ones.
void ExpectHandstand(FrameSource* source) {
  const Recording recording = ReadRecording(Handstand(), {});
  StreamFrame frame;
  ASSERT_EQ(source->Next(10s, &frame), StreamEvent::kLayout);
  EXPECT_EQ(source->layout().labels, recording.markers.labels());
  EXPECT_EQ(source->layout().rate, 100);
  for (int i = 0; i < 5; ++i) {
    ASSERT_EQ(source->Next(10s, &frame), StreamEvent::kFrame);
    const auto expected = recording.markers.frame(static_cast<int>(frame.number - 1) % 20);
    EXPECT_LT((frame.points - expected).cwiseAbs().maxCoeff(), 1e-6);  // floats of millimetres
  }
}

TEST(Serve, AsQtm) {
  StartedProgram program({"serve", Handstand(), "--as", "qtm", "--port", "0", "--speed", "max",
                          "--loop", "--frames", "0:20", "--stream-up", "-y"});
  const std::string address = AddressOf(program);
  ASSERT_THAT(address, HasSubstr("qtm://127.0.0.1:"));
  const auto source = OpenSource(address);
  ExpectHandstand(source.get());
  program.Send(SIGINT);
  EXPECT_EQ(program.Wait(), 0);
  EXPECT_THAT(program.Said(),
              AllOf(HasSubstr("53 markers, 20 frames at 100 Hz"), HasSubstr("Ended after ")));
}

TEST(Serve, AsNatNet) {
  StartedProgram program({"serve", Handstand(), "--as", "natnet", "--port", "0", "--speed", "20",
                          "--loop", "--frames", "0:20", "--protocol", "3.0", "--stream-up", "z"});
  const std::string address = AddressOf(program);
  ASSERT_THAT(address, AllOf(HasSubstr("natnet://127.0.0.1:"), HasSubstr("?up=+z")));
  const int free_port = UdpSocket("127.0.0.1", 0).port();
  const auto source = OpenSource(address + "&data=" + std::to_string(free_port));
  ExpectHandstand(source.get());
  program.Send(SIGTERM);
  EXPECT_EQ(program.Wait(), 0);
}

TEST(Serve, WhatIsNotUnderstood) {
  const auto expect = [](std::vector<std::string> options, int exit_code, const std::string& said) {
    options.insert(options.begin(), {"serve", Handstand()});
    const auto run = RunProgram(options);
    EXPECT_EQ(run.exit_code, exit_code) << said;
    EXPECT_THAT(run.err, HasSubstr(said));
  };
  expect({}, 2, "as which system?");
  expect({"--as", "vicon"}, 2, "qtm or natnet");
  expect({"--as", "qtm", "--protocol", "2.0"}, 2, "1.8 to 1.28");
  expect({"--as", "natnet", "--protocol", "1.0"}, 2, "2.5 to 4.2");
  expect({"--as", "qtm", "--multicast", "239.255.42.99"}, 2, "only for --as natnet");
  expect({"--as", "natnet", "--discovery"}, 2, "only for --as qtm");
  expect({"--as", "qtm", "--speed", "0"}, 2, "0.001 to 1000, or max");
  expect({"--as", "qtm", "--port", "70000"}, 2, "port");
  expect({"--as", "qtm", "--bind", "203.0.113.1"}, 1, "can't be served");
  expect({"--as", "natnet", "--port", "0", "--multicast", "10.0.0.1"}, 1, "no multicast group");
}

}  // namespace
}  // namespace mmm_converter
