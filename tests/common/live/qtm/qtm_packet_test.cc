// SPDX-License-Identifier: MIT
#include "common/live/qtm/qtm_packet.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/io/bytes/file_content.h"
#include "common/live/qtm/qtm_data.h"
#include "common/live/qtm/qtm_parameters.h"
#include "common/support/error.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::ThrowsMessage;

constexpr float kMissing = std::numeric_limits<float>::quiet_NaN();

TEST(QtmPacket, TextEventAndSize) {
  std::string bytes;
  AppendQtmText(QtmPacketType::kCommand, "Version 1.25", &bytes);
  EXPECT_EQ(bytes, std::string("\x15\0\0\0\1\0\0\0Version 1.25\0", 21));
  EXPECT_EQ(QtmPacketSize(bytes), 21U);
  EXPECT_EQ(QtmPacketSize(bytes.substr(0, 3)), 0U);
  EXPECT_EQ(QtmText(ParseQtmPacket(bytes)), "Version 1.25");
  EXPECT_EQ(QtmText({QtmPacketType::kCommand, "without its NUL"}), "without its NUL");
  bytes.clear();
  AppendQtmEvent(QtmEvent::kShuttingDown, &bytes);
  EXPECT_EQ(bytes, std::string("\x9\0\0\0\6\0\0\0\xC", 9));
  EXPECT_EQ(ParseQtmEvent(ParseQtmPacket(bytes)), QtmEvent::kShuttingDown);
}

TEST(QtmPacket, BrokenOnes) {
  const auto expect = [](const std::string& bytes, const std::string& said) {
    EXPECT_THAT([&] { ParseQtmPacket(bytes); }, ThrowsMessage<Error>(HasSubstr(said)));
  };
  expect(std::string("\x7\0\0", 3), "byte 0");
  expect(std::string("\x9\0\0\0\6\0\0\0", 8), "9 bytes, of which there are 8");
  expect(std::string("\x8\0\0\0\xFF\0\0\0", 8), "unknown type 255");
  EXPECT_THROW(QtmPacketSize(std::string("\x7\0\0\0", 4)), Error);
  EXPECT_THROW(QtmPacketSize(std::string("\0\0\0\x7F", 4)), Error);
  EXPECT_THROW(ParseQtmEvent({QtmPacketType::kEvent, ""}), Error);
  EXPECT_THROW(ParseQtmEvent({QtmPacketType::kEvent, "ab"}), Error);
}

TEST(QtmPacket, Discovery) {
  EXPECT_EQ(FormatQtmDiscovery(0x1234), std::string("\xA\0\0\0\7\0\0\0\x12\x34", 10));
  EXPECT_EQ(ParseQtmDiscovery(FormatQtmDiscovery(50000)), 50000);
  const std::string answer = FormatQtmAnnouncement({"LAB, QTM 2.5 (build 568), 5 cameras", 22222});
  const QtmAnnouncement announcement = ParseQtmAnnouncement(answer);
  EXPECT_EQ(announcement.text, "LAB, QTM 2.5 (build 568), 5 cameras");
  EXPECT_EQ(announcement.base_port, 22222);
  EXPECT_EQ(answer.substr(answer.size() - 2), std::string("\x56\xCE"));
  EXPECT_THROW(ParseQtmAnnouncement(FormatQtmDiscovery(1)), Error);
  EXPECT_THROW(ParseQtmDiscovery(answer), Error);
}

QtmData Sample() {
  QtmData data;
  data.camera_time = 123456789012;
  data.frame = 4711;
  data.labelled = {{{1, 2, 3}, 0, 0.5F}, {{kMissing, kMissing, kMissing}, 0, kMissing}};
  data.unlabelled = {{{-4, 5.5F, 6}, 77, 0.25F}};
  return data;
}

std::string BodyOf(const std::string& packet) { return std::string(ParseQtmPacket(packet).body); }

TEST(QtmData, EveryComponentReadAgain) {
  std::vector<QtmComponent> all;
  for (std::uint32_t i = 1; i <= 19; ++i) all.push_back(static_cast<QtmComponent>(i));
  for (const bool with_residuals : {false, true}) {
    std::vector<QtmComponent> components = all;
    std::erase_if(components, [&](QtmComponent c) {
      return c == (with_residuals ? QtmComponent::k3d : QtmComponent::k3dResiduals) ||
             c == (with_residuals ? QtmComponent::k3dNoLabels : QtmComponent::k3dNoLabelsResiduals);
    });
    std::string packet;
    AppendQtmData(Sample(), components, &packet);
    QtmData data;
    ParseQtmData(BodyOf(packet), &data);
    EXPECT_EQ(data.camera_time, 123456789012U);
    EXPECT_EQ(data.frame, 4711U);
    ASSERT_TRUE(data.has_labelled && data.has_unlabelled);
    ASSERT_THAT(data.labelled, SizeIs(2));
    EXPECT_THAT(data.labelled[0].position, ElementsAre(1, 2, 3));
    EXPECT_EQ(data.labelled[0].residual, with_residuals ? 0.5F : 0);
    for (const float value : data.labelled[1].position) EXPECT_TRUE(std::isnan(value));
    ASSERT_THAT(data.unlabelled, SizeIs(1));
    EXPECT_EQ(data.unlabelled[0].id, 77U);
  }
}

TEST(QtmData, BytesOfThePaper) {
  QtmData data = Sample();
  data.unlabelled.clear();
  std::string packet;
  AppendQtmData(data, {QtmComponent::k3d}, &packet);
  ASSERT_EQ(packet.size(), 24U + 16 + 2 * 12);
  EXPECT_EQ(packet.substr(20, 4), std::string("\1\0\0\0", 4));
  EXPECT_EQ(packet.substr(24, 8), std::string("\x28\0\0\0\1\0\0\0", 8));
  EXPECT_EQ(packet.substr(52), std::string(12, '\xFF'));
}

TEST(QtmData, CutAtEveryByteIsRefused) {
  std::string packet;
  AppendQtmData(Sample(), {QtmComponent::k3dResiduals, QtmComponent::k3dNoLabels}, &packet);
  const std::string body = BodyOf(packet);
  QtmData data;
  for (std::size_t length = 0; length < body.size(); ++length) {
    EXPECT_THROW(ParseQtmData(body.substr(0, length), &data), Error) << length;
  }
  EXPECT_THROW(ParseQtmData(body + '\0', &data), Error);
}

TEST(QtmData, WrongCountsAreRefused) {
  std::string packet;
  AppendQtmData(Sample(), {QtmComponent::k3d}, &packet);
  QtmData data;
  for (const std::size_t at : {12U, 16U, 24U}) {  // components, size of the component, points
    for (const char value : {'\0', '\x7', '\xFF'}) {
      std::string body = BodyOf(packet);
      body[at] = value;
      EXPECT_THROW(ParseQtmData(body, &data), Error) << at;
      body[at + 3] = '\x7F';
      EXPECT_THROW(ParseQtmData(body, &data), Error) << at;
    }
  }
}

TEST(QtmParametersRealFiles, OfRealQtm) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string xml = ReadFileContent(testing::SharedData("live/qtm/qtm_stream_3d.xml"));
  const QtmParameters parameters = ParseQtmParameters(xml);
  EXPECT_EQ(parameters.rate, 300);
  EXPECT_EQ(parameters.capture_time, 210);
  EXPECT_TRUE(parameters.has_3d);
  EXPECT_EQ(parameters.up_axis, UpAxis::kZ);
  EXPECT_EQ(parameters.calibration_time, "2015-11-13 08:03:05");
  ASSERT_THAT(parameters.labels, SizeIs(42));
  EXPECT_EQ(parameters.labels.front(), "SGL");
  EXPECT_EQ(parameters.labels[1], "R_HEAD");
  const std::size_t end = xml.rfind('>');
  for (std::size_t length = 0; length < end; length += 97) {
    EXPECT_THROW(ParseQtmParameters(xml.substr(0, length)), Error) << length;
  }
}

TEST(QtmParameters, WrittenAndReadAgainInEveryVersion) {
  QtmParameters written;
  written.rate = 119.88;
  written.capture_time = 12.5;
  written.up_axis = UpAxis::kMinusY;
  written.calibration_time = "2019-09-17 16:00:43";
  written.labels = {"Q_HeadL", "a < b & \"c\"",
                    "L\xC3\xB6"
                    "ffel 1"};
  for (int minor = kOldestQtmMinor; minor <= kNewestQtmMinor; ++minor) {
    const std::string xml =
        FormatQtmParameters(written, {true, true, true, true, true, true, true, true, true}, minor);
    const QtmParameters read = ParseQtmParameters(xml);
    EXPECT_EQ(read.rate, written.rate);
    EXPECT_EQ(read.capture_time, written.capture_time);
    EXPECT_EQ(read.up_axis, written.up_axis);
    EXPECT_EQ(read.labels, written.labels);
    EXPECT_EQ(read.calibration_time.has_value(), minor >= 10);
  }
  EXPECT_FALSE(ParseQtmParameters(FormatQtmParameters(written, {.general = true}, 25)).has_3d);
}

TEST(QtmParameters, WhatIsNotAsItShouldBe) {
  const auto expect = [](const std::string& contents, const std::string& said) {
    const std::string xml = "<QTM_Parameters_Ver_1.25>" + contents + "</QTM_Parameters_Ver_1.25>";
    EXPECT_THAT([&] { ParseQtmParameters(xml); }, ThrowsMessage<Error>(HasSubstr(said)));
  };
  expect("<General><Frequency>fast</Frequency></General>", "\"fast\"; it must be a number");
  expect("<The_3D><AxisUpwards>up</AxisUpwards></The_3D>", "AxisUpwards");
  expect("<The_3D><Labels>2</Labels><Label><Name>a</Name></Label></The_3D>", "says \"2\", and 1");
  expect("<The_3D><Labels>1</Labels><Label/></The_3D>", "without a <Name>");
  EXPECT_THROW(ParseQtmParameters("<html/>"), Error);
}

}  // namespace
}  // namespace mmm_converter
