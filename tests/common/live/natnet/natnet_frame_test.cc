// SPDX-License-Identifier: MIT
#include "common/live/natnet/natnet_frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "common/io/bytes/file_content.h"
#include "common/live/natnet/natnet_layout.h"
#include "common/support/error.h"
#include "tests/common/live/natnet/natnet_samples.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using testing::kNatNetVersions;
using testing::SampleNatNetFrame;
using testing::SampleNatNetModel;
using ::testing::SizeIs;

std::string Bytes(const NatNetFrame& frame, const NatNetVersion& version) {
  std::string payload;
  AppendNatNetFrame(frame, version, &payload);
  return payload;
}

NatNetFrame Read(std::string_view payload, const NatNetVersion& version) {
  NatNetFrame frame = SampleNatNetFrame();  // whose memory is used again
  ParseNatNetFrame(payload, version, &frame);
  return frame;
}

TEST(NatNetFrame, EverySectionInEveryVersion) {
  for (const NatNetVersion& version : kNatNetVersions) {
    const std::string payload = Bytes(SampleNatNetFrame(), version);
    const NatNetFrame frame = Read(payload, version);
    EXPECT_EQ(Bytes(frame, version), payload) << Format(version);
    EXPECT_EQ(frame.number, 4711);
    EXPECT_EQ(frame.marker_sets[1].name, "Ball");
    EXPECT_THAT(frame.marker_sets[1].positions[1], ElementsAre(7, 8, 9));
    EXPECT_THAT(frame.other_markers, SizeIs(1));
    EXPECT_EQ(frame.bodies[0].error, 0.001F);
    EXPECT_THAT(frame.bodies[0].markers, SizeIs(version < kNatNet3 ? 1 : 0));
    EXPECT_EQ(frame.skeletons[0].bones[0].id, testing::MarkerId(2, 1));
    EXPECT_THAT(frame.assets, SizeIs(version >= kNatNetWithSizes ? 1 : 0));
    ASSERT_THAT(frame.markers, SizeIs(5));
    EXPECT_EQ(frame.markers[1].parameters, version >= kNatNetWithBodyParameters ? 11 : 0);
    EXPECT_EQ(frame.markers[0].residual, version >= kNatNet3 ? 0.0001F : 0);
    EXPECT_THAT(frame.force_plates, SizeIs(version >= kNatNetWithForcePlates ? 1 : 0));
    EXPECT_THAT(frame.devices, SizeIs(version >= kNatNetWithDevices ? 1 : 0));
    EXPECT_EQ(frame.time, version >= kNatNetWithBodyParameters ? 39.25 : 0);
    EXPECT_EQ(frame.sent, version >= kNatNet3 ? std::uint64_t{1} << 40 : 0U);
    EXPECT_EQ(frame.precise_fraction, version >= kNatNetWithSizes ? 6U : 0U);
  }
}

TEST(NatNetFrame, CutAtEveryByteIsRefused) {
  NatNetFrame frame;
  for (const NatNetVersion& version : kNatNetVersions) {
    const std::string payload = Bytes(SampleNatNetFrame(), version);
    for (std::size_t length = 0; length < payload.size(); ++length) {
      EXPECT_THROW(ParseNatNetFrame(payload.substr(0, length), version, &frame), Error)
          << Format(version) << " " << length;
    }
    EXPECT_THROW(ParseNatNetFrame(payload + '\0', version, &frame), Error);
  }
}

TEST(NatNetFrame, AnyByteChangedNeverReadsOutOfBounds) {
  NatNetFrame frame;
  int refused = 0;
  const std::string payload = Bytes(SampleNatNetFrame(), {4, 1});
  for (std::size_t at = 0; at < payload.size(); ++at) {
    std::string changed = payload;
    changed[at] = '\xFF';
    try {
      ParseNatNetFrame(changed, {4, 1}, &frame);
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 50);
}

TEST(NatNetFrame, OfAVersionToComeWithMoreAtTheEnds) {
  std::string payload = Bytes(SampleNatNetFrame(), {4, 1});
  payload += "more";
  EXPECT_EQ(Read(payload, {4, 3}).markers.size(), 5U);
}

/// The payload of a real message.
std::string RealPayload(const std::string& name) {
  const std::string bytes = ReadFileContent(testing::SharedData("live/" + name));
  const NatNetMessage message = ParseNatNetMessage(bytes);
  EXPECT_EQ(message.payload.size(), bytes.size() - 4);
  return std::string(message.payload);
}

struct RealFrame {
  const char* file = "";
  NatNetVersion version;
  int number = 0;
  int markers = 0;
  double time = 0;
};

TEST(NatNetFrameRealFiles, OfMotive) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  for (const RealFrame& real :
       {RealFrame{"natnet_2.x/frame-motive-1.5.0-001.bin", {2, 5}, 92881, 3, 0},
        RealFrame{"natnet_2.x/frame-motive-1.7.2-001.bin", {2, 7}, 411213, 3, 3426.775},
        RealFrame{"natnet_2.x/frame-motive-1.9.0-001.bin", {2, 9}, 11823217, 3, 98526.80833333333},
        RealFrame{"natnet_3.0/mocapframe_packet_v3.bin", {3, 0}, 162734, 6, 1356.1166666666666},
        RealFrame{"natnet_3.0/mocapframe_packet_occluded_v3.bin", {3, 0}, 269007, 4, 8966.9}}) {
    const std::string payload = RealPayload(real.file);
    const NatNetFrame frame = Read(payload, real.version);
    EXPECT_EQ(frame.number, real.number) << real.file;
    EXPECT_THAT(frame.markers, SizeIs(real.markers)) << real.file;
    EXPECT_DOUBLE_EQ(frame.time, real.time) << real.file;
    EXPECT_EQ(Bytes(frame, real.version), payload) << real.file;
    NatNetFrame cut;
    for (std::size_t length = 0; length < payload.size(); ++length) {
      EXPECT_THROW(ParseNatNetFrame(payload.substr(0, length), real.version, &cut), Error)
          << real.file << " " << length;
    }
  }
}

TEST(NatNetModel, EveryDescriptionInEveryVersion) {
  for (const NatNetVersion& version : kNatNetVersions) {
    const std::string payload = FormatNatNetModel(SampleNatNetModel(), version);
    const NatNetModel model = ParseNatNetModel(payload, version);
    EXPECT_EQ(FormatNatNetModel(model, version), payload) << Format(version);
    EXPECT_EQ(model.marker_sets[0].markers[1], "RFHD");
    EXPECT_EQ(model.bodies[0].id, 3);
    EXPECT_THAT(model.bodies[0].markers, SizeIs(version >= kNatNet3 ? 2 : 0));
    EXPECT_EQ(model.skeletons[0].bones[0].name, "Hips");
    EXPECT_THAT(model.force_plates, SizeIs(version >= kNatNetWithForcePlates ? 1 : 0));
    EXPECT_THAT(model.assets, SizeIs(version >= kNatNetWithSizes ? 1 : 0));
    for (std::size_t length = 0; length < payload.size(); ++length) {
      EXPECT_THROW(ParseNatNetModel(payload.substr(0, length), version), Error) << length;
    }
  }
}

TEST(NatNetModel, UnknownDescriptionsArePassedOverByTheirSize) {
  std::string payload = FormatNatNetModel(SampleNatNetModel(), {4, 1});
  ++payload[0];
  payload += std::string("\x63\0\0\0\3\0\0\0abc", 11);
  EXPECT_EQ(ParseNatNetModel(payload, {4, 1}).assets[0].markers[0].name, "G2");
  EXPECT_THROW(ParseNatNetModel(std::string("\1\0\0\0\x63\0\0\0", 8), {3, 0}), Error);
}

TEST(NatNetModelRealFiles, OfMotive) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string payload = RealPayload("natnet_3.0/modeldef_packet_v3.bin");
  const NatNetModel model = ParseNatNetModel(payload, {3, 0});
  ASSERT_THAT(model.bodies, SizeIs(1));
  EXPECT_EQ(model.bodies[0].name, "RaceQuad");
  EXPECT_EQ(model.bodies[0].id, 2);
  EXPECT_THAT(model.bodies[0].markers, SizeIs(5));
  ASSERT_THAT(model.marker_sets, SizeIs(2));
  EXPECT_THAT(model.marker_sets[0].markers,
              ElementsAre("Marker1", "Marker2", "Marker3", "Marker4", "Marker5"));
  for (std::size_t length = 0; length < payload.size(); ++length) {
    EXPECT_THROW(ParseNatNetModel(payload.substr(0, length), {3, 0}), Error) << length;
  }
}

TEST(NatNetMessage, ServerInfo) {
  for (const NatNetVersion& version : kNatNetVersions) {
    NatNetServerInfo info{"Motive", {2, 1, 0, 0}, version, 3312787, 40000, true, "239.1.2.3"};
    const std::string payload = FormatNatNetServerInfo(info);
    EXPECT_EQ(payload.size(), version >= kNatNet3 ? 279U : 264U);
    const NatNetServerInfo read = ParseNatNetServerInfo(payload);
    EXPECT_EQ(read.version, version);
    EXPECT_EQ(read.application, "Motive");
    EXPECT_EQ(read.data_port, version >= kNatNet3 ? 40000 : 1511);
    EXPECT_EQ(read.group, version >= kNatNet3 ? "239.1.2.3" : "239.255.42.99");
    EXPECT_THROW(ParseNatNetServerInfo(payload.substr(0, payload.size() - 1)), Error);
  }
  EXPECT_THROW(ParseNatNetMessage("abc"), Error);
  EXPECT_EQ(FormatNatNetConnect("us", {4, 1}).size(), 270U);
  EXPECT_EQ(FormatNatNetMessage(NatNetId::kKeepAlive, ""), std::string("\xA\0\0\0", 4));
}

TEST(NatNetMessageRealFiles, ServerInfoOfMotive) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const NatNetServerInfo info =
      ParseNatNetServerInfo(RealPayload("natnet_3.0/serverinfo_packet_v3.bin"));
  EXPECT_EQ(info.application, "Motive");
  EXPECT_THAT(info.application_version, ElementsAre(2, 1, 0, 0));
  EXPECT_EQ(info.version, kNatNet3);
  EXPECT_EQ(info.clock_rate, 3312787U);
  EXPECT_EQ(info.data_port, 1511);
  EXPECT_TRUE(info.is_multicast);
  EXPECT_EQ(info.group, "239.255.42.99");
}

TEST(NatNetMessageRealFiles, OtherOnesOfMotive) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const auto expect = [](const std::string& name, NatNetId id, std::size_t bytes) {
    const std::string datagram = ReadFileContent(testing::SharedData("live/" + name));
    const NatNetMessage message = ParseNatNetMessage(datagram);
    EXPECT_EQ(message.id, id) << name;
    EXPECT_EQ(message.payload.size(), bytes) << name;
  };
  expect("natnet_3.0/connect_packet_v3.bin", NatNetId::kConnect, 264);
  expect("natnet_3.0/discovery_packet_v3.bin", NatNetId::kDiscovery, 264);
  expect("natnet_3.0/echorequest_packet_v3.bin", NatNetId::kEchoRequest, 8);
  expect("natnet_3.0/echoresponse_packet_v3.bin", NatNetId::kEchoResponse, 16);
  expect("natnet_3.0/requestmodeldef_packet_v3.bin", NatNetId::kRequestModel, 0);
  for (const auto& [motive, minor] : {std::pair("1.5.0", 5), {"1.7.2", 7}, {"1.9.0", 9}}) {
    const std::string payload =
        RealPayload(std::string("natnet_2.x/frame-motive-") + motive + "-000.bin");
    EXPECT_EQ(ParseNatNetServerInfo(payload).version, (NatNetVersion{2, minor}));
    EXPECT_EQ(ParseNatNetServerInfo(payload).application, "NatNetLib");
  }
}

TEST(NatNetMessage, Versions) {
  EXPECT_EQ(ParseNatNetVersion("3.0"), kNatNet3);
  EXPECT_EQ(ParseNatNetVersion("4"), kNatNet4);
  EXPECT_EQ(Format({2, 11}), "2.11");
  for (const char* text : {"", "2.4", "4.3", "3.x", "a", "3.0.1", "-3"}) {
    EXPECT_THROW(ParseNatNetVersion(text), Error) << text;
  }
}

}  // namespace
}  // namespace mmm_converter
