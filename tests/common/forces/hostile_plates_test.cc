// SPDX-License-Identifier: MIT
// Files whose plates are not what they state.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/forces/plate_forces.h"
#include "common/support/atomic_file.h"
#include "common/support/units.h"
#include "tests/support/c3d_bytes.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr int kFrames = 60;
constexpr int kChannels = 6;

std::string Words(int count, const std::vector<int>& words) {
  std::string data;
  for (int i = 0; i < count; ++i) {
    const int word = words[static_cast<std::size_t>(i) % words.size()];
    data += static_cast<char>(word & 0xFF);
    data += static_cast<char>(word >> 8);
  }
  return data;
}

/// A file of six channels, and how many plates it states, each on the same channels.
class HostilePlatesTest : public ::testing::Test {
 protected:
  HostilePlatesTest() {
    for (int k = 0; k < kFrames; ++k) {
      const float load = k < 30 ? 0 : -700;
      const auto sways = static_cast<float>(k);  // N mm: what never changes is saturated
      bytes_.frames.push_back({0, 0, 0, 0, 10, 20, load, sways, sways, 500});
    }
    bytes_.points = 1;
    bytes_.analog_words = kChannels;
    bytes_.analog_samples = 1;
  }

  RecordedForces Read(int stated, int there) {
    std::vector<float> corners;
    for (int i = 0; i < there; ++i) {
      corners.insert(corners.end(), corners_.begin(), corners_.end());
    }
    C3dSection section;
    section.Group(1, "POINT").Word(1, "USED", {1}).Float(1, "RATE", 100).Texts(1, "UNITS", 2, "mm");
    section.Group(2, "ANALOG").Word(2, "USED", {kChannels}).Float(2, "RATE", 100);
    section.Float(2, "GEN_SCALE", 1).Floats(2, "SCALE", {kChannels}, {1, 1, 1, 1, 1, 1});
    section.Parameter(2, "OFFSET", 2, {kChannels}, Words(kChannels, {0}), -1);
    section.Texts(2, "UNITS", 3, "N  N  N  NmmNmmNmm");
    section.Group(3, "FORCE_PLATFORM").Word(3, "USED", {stated});
    section.Parameter(3, "TYPE", 2, {there}, Words(there, {2}), -1);
    section.Parameter(3, "CHANNEL", 2, {kChannels, there}, Words(kChannels * there, channels_), -1);
    section.Floats(3, "CORNERS", {3, 4, there}, corners);
    section.Floats(3, "ORIGIN", {3, there}, std::vector<float>(3 * there, 0));
    const std::string file = testing::TestFolder() + "/plates.c3d";
    WriteFileAtomically(file, bytes_.File(section));
    warnings_ = Warnings();
    return ReadForces(file, &warnings_);
  }

  testing::C3dBytes bytes_;
  std::vector<int> channels_ = {1, 2, 3, 4, 5, 6};
  std::vector<float> corners_ = {500, 0, 0, 0, 0, 0, 0, 400, 0, 500, 400, 0};
  Warnings warnings_;
  using C3dSection = testing::C3dSection;
};

TEST_F(HostilePlatesTest, APlate) {
  const RecordedForces forces = Read(1, 1);
  ASSERT_THAT(forces.plates, SizeIs(1));
  ASSERT_THAT(forces.plates[0].loads, SizeIs(1));
  EXPECT_EQ(forces.plates[0].loads[0].begin, 30);
  EXPECT_NEAR(forces.plates[0].force(2, 40), 700, 1e-6);
  EXPECT_NEAR(forces.plates[0].cop(0, 40), 0.25, 1e-3);
}

TEST_F(HostilePlatesTest, AThousandOfThem) {
  EXPECT_THAT(Read(1000, 200).plates, SizeIs(200));  // no parameter has room for more than 255
  EXPECT_FALSE(warnings_.empty());
  EXPECT_THAT(Read(60000, 1).plates, SizeIs(1));
}

TEST_F(HostilePlatesTest, ChannelsThatAreNotThere) {
  channels_ = {1, 2, 3, 4, 5, 7};
  EXPECT_TRUE(Read(1, 1).plates.empty());
  EXPECT_THAT(warnings_.texts(), Contains(HasSubstr("force plate 1")));
  EXPECT_THAT(warnings_.texts(), Contains(HasSubstr("channel 7 is not there")));
  channels_ = {0, 65535, 3, 4, 5, 6};
  EXPECT_TRUE(Read(1, 1).plates.empty());
}

TEST_F(HostilePlatesTest, CornersWithoutASurface) {
  corners_.assign(12, 0);
  EXPECT_TRUE(Read(1, 1).plates.empty());
  EXPECT_THAT(warnings_.texts(), Contains(HasSubstr("do not span a surface")));
  corners_.assign(12, static_cast<float>(kNaN));
  EXPECT_TRUE(Read(1, 1).plates.empty());
}

TEST_F(HostilePlatesTest, SamplesThatAreNoNumbers) {
  bytes_.frames[40][4] = static_cast<float>(kNaN);
  const RecordedForces forces = Read(1, 1);
  ASSERT_THAT(forces.plates, SizeIs(1));
  EXPECT_FALSE(forces.plates[0].force.col(40).allFinite());
  EXPECT_FALSE(forces.plates[0].cop.col(40).allFinite());
  EXPECT_NEAR(forces.plates[0].force(2, 41), 700, 1e-6);
  for (std::vector<float>& frame : bytes_.frames) {
    for (std::size_t i = 4; i < frame.size(); ++i) frame[i] = static_cast<float>(kNaN);
  }
  for (const PlateForces& one : Read(1, 1).plates) EXPECT_TRUE(one.loads.empty());
}

}  // namespace
}  // namespace mmm_converter
