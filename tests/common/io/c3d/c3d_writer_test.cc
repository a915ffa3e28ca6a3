// SPDX-License-Identifier: MIT
#include "common/io/c3d/c3d_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <numeric>

#include "common/io/c3d/c3d_reader.h"
#include "common/support/error.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using ::testing::IsEmpty;

constexpr double kUnseen = std::numeric_limits<double>::quiet_NaN();

std::string TempPath(const std::string& name) { return testing::TestFolder() + "/" + name; }

/// Positions with a pattern of their own; every seventh point is not seen.
MarkerSequence MakeSequence(int labels, int frames) {
  std::vector<std::string> names;
  names.reserve(labels);
  for (int i = 0; i < labels; ++i) names.push_back("Marker" + std::to_string(i));
  MarkerSequence sequence(names, frames, 100, 0);
  for (int k = 0; k < frames; ++k) {
    for (int i = 0; i < labels; ++i) {
      if ((k + i) % 7 == 0) continue;
      sequence.frame(k).col(i) << 0.001 * i + 0.1, -0.00001 * k, 1.5 + 0.01 * (k % 100);
    }
  }
  return sequence;
}

/// Written and read again, in metres.
void ExpectRoundTrip(const MarkerSequence& sequence, const C3dWriteOptions& options) {
  const std::string path = TempPath("round_trip.c3d");
  WriteC3d(path, sequence, options);
  Warnings warnings;
  C3dReader reader(path, &warnings);
  const C3dInfo& info = reader.info();
  EXPECT_THAT(warnings.texts(), IsEmpty());
  EXPECT_EQ(info.labels, sequence.labels());
  EXPECT_EQ(info.layout.frames, sequence.num_frames());
  EXPECT_EQ(info.layout.rate, sequence.rate());
  EXPECT_EQ(info.layout.first_frame, options.first_frame);
  EXPECT_EQ(info.unit, "mm");
  EXPECT_EQ(info.comment, options.comment);
  std::vector<int> all(sequence.num_labels());
  std::iota(all.begin(), all.end(), 0);
  const MarkerSequence read = reader.ReadPoints(all, info.labels, info.layout.rate);
  int differing = 0;
  for (int k = 0; k < sequence.num_frames(); ++k) {
    for (int i = 0; i < sequence.num_labels(); ++i) {
      const Eigen::Vector3d written = sequence.frame(k).col(i);
      const Eigen::Vector3d back = read.frame(k).col(i) / 1000;
      // Floats have 24 bits: 1e-7 of at most 2.5 m, in m.
      differing += IsSeen(written) ? !back.isApprox(written, 2e-7) : IsSeen(back);
    }
  }
  EXPECT_EQ(differing, 0);
}

TEST(C3dWriter, ReadsBackWhatItWrote) {
  ExpectRoundTrip(MakeSequence(53, 40), {});
  ExpectRoundTrip(MakeSequence(53, 40), {.first_frame = 695, .comment = "SYNTHETIC: a test"});
  ExpectRoundTrip(MakeSequence(1, 1), {});
}

TEST(C3dWriter, ContinuesLabelsBeyond255) {
  ExpectRoundTrip(MakeSequence(255, 3), {});
  ExpectRoundTrip(MakeSequence(256, 3), {});
  ExpectRoundTrip(MakeSequence(1000, 2), {});
}

TEST(C3dWriter, CountsFramesBeyond65535) {
  ExpectRoundTrip(MakeSequence(2, 65535), {});
  ExpectRoundTrip(MakeSequence(2, 65536), {});
  ExpectRoundTrip(MakeSequence(2, 70000), {.first_frame = 65535});
  ExpectRoundTrip(MakeSequence(2, 5), {.first_frame = 65536});
  ExpectRoundTrip(MakeSequence(2, 70000), {.first_frame = 700000});
}

TEST(C3dWriter, RefusesWhatTheFormatCanNotHold) {
  const std::string path = TempPath("refused.c3d");
  EXPECT_THROW(WriteC3d(path, MakeSequence(0, 5)), Error);
  EXPECT_THROW(WriteC3d(path, MakeSequence(5, 0)), Error);
  EXPECT_THROW(WriteC3d(path, MakeSequence(65536, 1)), Error);
  EXPECT_THROW(WriteC3d(path, MakeSequence(60000, 1)), Error);  // labels fill the section
  EXPECT_THROW(WriteC3d(path, MarkerSequence({std::string(128, 'x')}, 1, 100, 0)), Error);
  EXPECT_THROW(WriteC3d(path, MakeSequence(1, 1), {.first_frame = 0}), Error);
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(C3dWriter, WritesUnseenAsInvalidZero) {
  MarkerSequence sequence({"A", "B"}, 1, 100, 0);
  sequence.frame(0) << 0.1, kUnseen, 0.2, kUnseen, 0.3, kUnseen;
  const std::string path = TempPath("unseen.c3d");
  WriteC3d(path, sequence);
  C3dReader reader(path);
  const std::vector<C3dPoint> points = reader.ReadFrame(0);
  EXPECT_TRUE(points[0].valid);
  EXPECT_FALSE(points[1].valid);
  EXPECT_EQ(points[1].position, Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace mmm_converter
