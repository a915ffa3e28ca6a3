// SPDX-License-Identifier: MIT
#include "common/live/zmq/posture_message.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <zmq.hpp>

#include "common/live/zmq/zmq_sink.h"
#include "common/model/forward_kinematics.h"
#include "common/support/error.h"
#include "tests/common/live/zmq/small_body.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using testing::FreePort;
using testing::SmallBody;
using testing::SmallFrame;

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
  const PoseFrame frame = SmallFrame(*body);
  const PostureMessage message = PostureMessageFormat(*body).Format(*body, frame, {});
  ExpectPosture(*body, frame, message.header, message.arrays);
}

TEST(PostureMessage, WithoutAPersonThePostureIsUnknown) {
  const auto body = SmallBody();
  PoseFrame frame = SmallFrame(*body);
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
  const PoseFrame frame = SmallFrame(*body);
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

// Each has a topic of its own, behind the one that has all.
TEST(ZmqSink, ObjectsHaveTopics) {
  const std::string endpoint = fmt::format("tcp://127.0.0.1:{}", FreePort());
  zmq::context_t context;
  const auto sink = OpenZmqSink("zmq" + endpoint.substr(3));
  zmq::socket_t subscriber(context, zmq::socket_type::sub);
  subscriber.set(zmq::sockopt::subscribe, "posture/box");
  subscriber.set(zmq::sockopt::rcvtimeo, 20);
  subscriber.connect(endpoint);
  auto person = std::make_shared<LiveBody>(*SmallBody());
  auto box = std::make_shared<LiveBody>(*person);
  person->count = box->count = 2;
  box->index = 1;
  box->name = "box";
  zmq::message_t topic, header;
  for (int tries = 0; tries < 500 && topic.size() == 0; ++tries) {
    sink->Write(person, SmallFrame(*person));
    sink->Write(box, SmallFrame(*box));
    if (!subscriber.recv(topic)) continue;
    ASSERT_TRUE(subscriber.recv(header));
  }
  EXPECT_EQ(topic.to_string(), "posture/box");
  EXPECT_EQ(nlohmann::json::parse(header.to_string())["body"], "box");
}

}  // namespace
}  // namespace mmm_converter
