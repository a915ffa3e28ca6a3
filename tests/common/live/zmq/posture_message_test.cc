// SPDX-License-Identifier: MIT
#include "common/live/zmq/posture_message.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <zmq.hpp>

#include "common/live/zmq/zmq_sink.h"
#include "common/model/forward_kinematics.h"
#include "common/support/error.h"
#include "common/support/units.h"
#include "tests/common/live/fake_converter.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using testing::SmallSetup;

std::shared_ptr<const LiveBody> SmallBody() {
  auto body = std::make_shared<LiveBody>();
  body->name = "anna";
  body->setup = SmallSetup(3);
  body->setup.joints = {1, 0};
  body->labels = {"a", "b", "c", "spare"};
  return body;
}

PoseFrame Frame(const LiveBody& body) {
  PoseFrame frame;
  frame.number = 42;
  frame.time = 1.25;
  frame.is_tracking = true;
  frame.points.setConstant(3, 4, 0.5);
  frame.points.col(1).setConstant(kNaN);
  FrameEstimate& estimate = frame.estimate;
  estimate.posture = ZeroPosture(*body.setup.model);
  estimate.posture.position << 1, 2, 3;
  estimate.posture.joint_angles[0] = 0.1;
  estimate.posture.joint_angles[1] = 0.2;
  estimate.standard_deviations =
      Eigen::VectorXd::LinSpaced(6 + body.setup.model->num_joints(), 0.01, 0.02);
  estimate.residuals = Eigen::Vector3d(0.01, kNaN, 0.03);
  estimate.verdicts = Eigen::Vector3i(kAsLabelled, kAsLabelled, 0);
  return frame;
}

// Arrays of f64 by name.
std::map<std::string, std::vector<double>> Unpack(const nlohmann::json& header,
                                                  const std::string& bytes) {
  std::map<std::string, std::vector<double>> arrays;
  std::size_t at = 0;
  for (const auto& field : header["fields"]) {
    std::size_t count = 1;
    for (const auto& side : field["shape"]) count *= side.get<std::size_t>();
    auto& array = arrays[field["name"]];
    for (std::size_t i = 0; i < count; ++i) {
      double value = 0;
      if (field["dtype"] == "f64") {
        std::memcpy(&value, bytes.data() + at, sizeof value);
        at += sizeof value;
      } else {
        value = static_cast<unsigned char>(bytes[at++]);
      }
      array.push_back(value);
    }
  }
  EXPECT_EQ(at, bytes.size());
  return arrays;
}

void ExpectPosture(const LiveBody& body, const PoseFrame& frame, const std::string& header_text,
                   const std::string& bytes) {
  const auto header = nlohmann::json::parse(header_text);
  EXPECT_EQ(header["frame"], 42);
  EXPECT_EQ(header["time"], 1.25);
  EXPECT_EQ(header["body"], "anna");
  EXPECT_EQ(header["tracking"], true);
  auto arrays = Unpack(header, bytes);
  EXPECT_THAT(arrays["root_position"], ElementsAre(1, 2, 3));
  EXPECT_THAT(arrays["root_orientation"], ElementsAre(1, 0, 0, 0));
  EXPECT_THAT(arrays["joint_angles"], ElementsAre(0.2, 0.1));
  EXPECT_THAT(arrays["marker_states"], ElementsAre(1, 0, 2, 3));
  EXPECT_EQ(arrays["marker_distances"][2], 0.03);
  EXPECT_TRUE(std::isnan(arrays["marker_distances"][3]));
  EXPECT_EQ(arrays["joint_sd"][0], frame.estimate.standard_deviations[7]);
  const auto poses = SegmentPoses(*body.setup.model, frame.estimate.posture);
  ASSERT_EQ(header["segments"].size(), poses.size());
  EXPECT_EQ(arrays["segment_positions"][3 * (poses.size() - 1) + 2],
            poses.back().translation().z());
}

TEST(PostureMessage, SaysThePosture) {
  const auto body = SmallBody();
  const PoseFrame frame = Frame(*body);
  const PostureMessage message = PostureMessageFormat(*body).Format(*body, frame, {});
  ExpectPosture(*body, frame, message.header, message.arrays);
}

TEST(PostureMessage, WithoutAPersonThePostureIsUnknown) {
  const auto body = SmallBody();
  PoseFrame frame = Frame(*body);
  frame.is_tracking = false;
  const PostureMessage message = PostureMessageFormat(*body).Format(*body, frame, {});
  const auto header = nlohmann::json::parse(message.header);
  auto arrays = Unpack(header, message.arrays);
  EXPECT_EQ(header["tracking"], false);
  for (const char* name : {"root_position", "root_orientation", "joint_angles", "segment_positions",
                           "marker_distances"}) {
    for (const double value : arrays[name]) EXPECT_TRUE(std::isnan(value)) << name;
  }
  EXPECT_THAT(arrays["marker_states"], ElementsAre(3, 0, 3, 3));
}

// A port that is free now.
int FreePort() {
  boost::asio::io_context context;
  using boost::asio::ip::tcp;
  const tcp::acceptor acceptor(context, {boost::asio::ip::make_address("127.0.0.1"), 0});
  return acceptor.local_endpoint().port();
}

TEST(ZmqSink, ASubscriberGetsThreeParts) {
  const std::string endpoint = fmt::format("tcp://127.0.0.1:{}", FreePort());
  zmq::context_t context;
  const auto sink = OpenZmqSink("zmq" + endpoint.substr(3));
  EXPECT_THROW(OpenZmqSink("zmq" + endpoint.substr(3)), Error);
  zmq::socket_t subscriber(context, zmq::socket_type::sub);
  subscriber.set(zmq::sockopt::subscribe, "posture");
  subscriber.set(zmq::sockopt::rcvtimeo, 20);
  subscriber.connect(endpoint);
  const auto body = SmallBody();
  const PoseFrame frame = Frame(*body);
  std::vector<std::string> parts;
  // A publisher says nothing to who has not subscribed yet.
  for (int tries = 0; tries < 500 && parts.empty(); ++tries) {
    sink->Write(body, frame);
    zmq::message_t part;
    while (subscriber.recv(part)) {
      parts.push_back(part.to_string());
      if (!part.more()) break;
    }
  }
  ASSERT_EQ(parts.size(), 3U);
  EXPECT_EQ(parts[0], "posture");
  ExpectPosture(*body, frame, parts[1], parts[2]);
}

}  // namespace
}  // namespace mmm_converter
