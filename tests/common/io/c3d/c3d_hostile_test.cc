// SPDX-License-Identifier: MIT
// Broken C3D files: each is either read as far as it is good, or refused with an Error.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include "common/io/bytes/file_content.h"
#include "common/io/c3d/c3d_reader.h"
#include "common/io/c3d/c3d_writer.h"
#include "common/io/recording/recording.h"
#include "common/support/error.h"
#include "tests/support/shared_data.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using ::mmm_converter::testing::SharedData;
using ::testing::Contains;
using ::testing::HasSubstr;

std::string TempPath() { return testing::TestFolder() + "/hostile.c3d"; }

std::string WriteHostile(const std::string& content) {
  std::string path = TempPath();
  std::filesystem::remove(path);  // to overwrite a file makes some file systems wait for the disk
  std::ofstream(path, std::ios::binary)
      .write(content.data(), static_cast<std::streamsize>(content.size()));
  return path;
}

std::string Synthetic(const std::string& name) {
  return ReadFileContent(SharedData("recordings/synthetic/" + name));
}

/// Frames read from these bytes; -1 where they are refused. Anything but an Error fails the test.
int FramesRead(const std::string& content) {
  try {
    const Recording recording = ReadRecording(WriteHostile(content), {});
    // Every coordinate comes from at least two bytes of the file.
    EXPECT_LE(recording.markers.num_frames() * std::uint64_t{6} * recording.markers.num_labels(),
              content.size());
    return recording.markers.num_frames();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("hostile.c3d"));  // it names the file
    return -1;
  }
}

std::string C3dMessageOf(const std::string& content) {
  try {
    ReadRecording(WriteHostile(content), {});
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// A small file of our own: 4 markers, 6 frames, 100 Hz.
std::string SmallFile() {
  MarkerSequence markers({"C7", "T10", "LFHD", "LTOE"}, 6, 100, 0);
  for (int k = 0; k < 6; ++k) {
    markers.frame(k) << 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 1.4, 1.2, 1.7, 0.1;
  }
  WriteC3d(TempPath(), markers);
  return ReadFileContent(TempPath());
}

void PutWord(std::string* file, int word, int value) {
  (*file)[2 * (word - 1)] = static_cast<char>(value & 0xFF);
  (*file)[2 * (word - 1) + 1] = static_cast<char>(value >> 8 & 0xFF);
}

void PutFloat(std::string* file, std::size_t byte, float value) {
  std::memcpy(&(*file)[byte], &value, 4);
}

/// First byte of the data of a parameter that is written without or with one dimension.
std::size_t DataOf(const std::string& file, const std::string& name, int dimensions = 0) {
  return file.find(name) + name.size() + 4 + dimensions;
}

TEST(HostileC3d, IsCutAnywhere) {
  const std::string file = SmallFile();
  const std::size_t data = 512 * (static_cast<unsigned char>(file[16]) - 1);
  for (std::size_t size = 1; size < file.size(); ++size) {
    const int frames = FramesRead(file.substr(0, size));
    const int whole =
        size < data ? 0 : static_cast<int>(std::min<std::size_t>((size - data) / 64, 6));
    EXPECT_EQ(frames, whole > 0 ? whole : -1) << "cut at " << size;
  }
}

TEST(HostileC3d, SaysWhereItIsCut) {
  const std::string file = SmallFile();
  EXPECT_THAT(C3dMessageOf(""), HasSubstr("empty"));
  EXPECT_THAT(C3dMessageOf(file.substr(0, 132)), HasSubstr("truncated: 132 bytes end before"));
  EXPECT_THAT(C3dMessageOf(file.substr(0, 511)), HasSubstr("truncated: 511 bytes end before"));
  EXPECT_THAT(C3dMessageOf(file.substr(0, 512)), HasSubstr("truncated: 512 bytes end before"));
  EXPECT_THAT(C3dMessageOf(file.substr(0, 1024)), HasSubstr("no whole frame"));
}

TEST(HostileC3dRealFiles, HasFlippedBytes) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string file = Synthetic("kit53_intel_int.c3d");
  const std::size_t data = 512 * (static_cast<unsigned char>(file[16]) - 1);
  std::mt19937 generator(1);
  int read = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    std::string broken = file;
    const int flips = 1 + trial % 4;
    for (int i = 0; i < flips; ++i) broken[generator() % data] = static_cast<char>(generator());
    read += FramesRead(broken) > 0;
  }
  EXPECT_GT(read, 1000);  // most bytes do not matter
}

TEST(HostileC3d, HasNoise) {
  std::mt19937 generator(2);
  for (int trial = 0; trial < 500; ++trial) {
    std::string noise(1 + generator() % 4096, '\0');
    for (char& byte : noise) byte = static_cast<char>(generator());
    noise[0] = 2;
    if (noise.size() > 1) noise[1] = 0x50;
    if (noise.size() > 515) noise[515] = static_cast<char>(84 + trial % 3);
    EXPECT_GE(FramesRead(noise), -1);
  }
}

TEST(HostileC3dRealFiles, TakesTheNumberOfPointsThatFitsTheFile) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  Warnings warnings;
  C3dReader reader(SharedData("recordings/synthetic/bad_hdr_points65535.c3d"), &warnings);
  EXPECT_EQ(reader.info().layout.points, 53);
  EXPECT_EQ(reader.info().layout.frames, 50);
  EXPECT_THAT(warnings.texts(), Contains(HasSubstr("the header says 65535 points")));
  C3dReader good(SharedData("recordings/synthetic/bad_param_offset_self_loop.c3d"));
  for (int k = 0; k < 50; ++k) {
    EXPECT_EQ(reader.ReadFrame(k)[52].position, good.ReadFrame(k)[52].position);
  }
}

TEST(HostileC3d, ContradictsItself) {
  const std::string good = SmallFile();
  const int data_block = static_cast<unsigned char>(good[16]);
  for (const int block : {0, 1, 2, 60000}) {  // header, parameters, beyond the end
    std::string file = good;
    PutWord(&file, 9, block);
    EXPECT_EQ(FramesRead(file), 6) << "data block " << block;
    PutWord(&file, static_cast<int>(DataOf(file, "DATA_START") / 2) + 1, data_block);
  }
  std::string file = good;
  PutFloat(&file, 12, 0);  // scale
  EXPECT_EQ(FramesRead(file), 6);
  PutFloat(&file, 12, std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(FramesRead(file), 6);
  file = good;
  PutWord(&file, 2, 0);  // points: POINT:USED
  EXPECT_EQ(FramesRead(file), 6);
  file = good;
  PutWord(&file, 3, 65535);  // analog samples: not one frame is left
  EXPECT_THAT(C3dMessageOf(file), HasSubstr("no whole frame"));
}

TEST(HostileC3d, HasNoRate) {
  const std::string good = SmallFile();
  for (const float rate : {0.0F, -5.0F, std::numeric_limits<float>::infinity(),
                           std::numeric_limits<float>::quiet_NaN()}) {
    std::string file = good;
    PutFloat(&file, DataOf(file, "RATE"), rate);
    EXPECT_EQ(FramesRead(file), 6);  // the header's
    PutFloat(&file, 20, rate);
    EXPECT_THAT(C3dMessageOf(file), HasSubstr("no frame rate"));
    EXPECT_EQ(ReadRecording(TempPath(), {.rate = 50}).markers.rate(), 50);
  }
}

TEST(HostileC3d, HasAnImpossibleRate) {
  const std::string good = SmallFile();
  for (const float rate : {1e-30F, 0.5F, 2e5F, 1e30F}) {
    std::string file = good;
    PutFloat(&file, DataOf(file, "RATE"), rate);
    EXPECT_EQ(FramesRead(file), 6);  // the header's
    PutFloat(&file, 20, rate);
    EXPECT_THAT(C3dMessageOf(file), HasSubstr(" Hz, which is outside 1 to 100000 Hz; give the"));
    EXPECT_EQ(ReadRecording(TempPath(), {.rate = 50}).markers.rate(), 50);
  }
}

TEST(HostileC3d, MarksMissingPointsInEveryWay) {
  const std::string good = SmallFile();
  const std::size_t data = 512 * (static_cast<unsigned char>(good[16]) - 1);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  struct {
    float x, y, z, word;
    bool seen;
  } const points[] = {{1, 2, 3, 0, true},        {1, 2, 3, -1, false},     {1, 2, 3, 65535, false},
                      {nan, 2, 3, 0, false},     {0, 0, 0, 0, false},      {0, 0, 1, 0, true},
                      {9999999, 0, 0, 0, false}, {1, 2, 3, 1.7e38F, true}, {1, 2, 3, nan, false},
                      {1, 2, 3, -16512, false},  {1, 2, 3, 32767, true},   {1, 2, 3, 32768, false},
                      {1, 2, 3, INFINITY, false}};
  for (const auto& p : points) {
    std::string file = good;
    PutFloat(&file, data, p.x);
    PutFloat(&file, data + 4, p.y);
    PutFloat(&file, data + 8, p.z);
    PutFloat(&file, data + 12, p.word);
    C3dReader reader(WriteHostile(file));
    EXPECT_EQ(IsSeen(reader.ReadPoints({0}, {"C7"}, 100).frame(0).col(0)), p.seen)
        << p.x << " " << p.y << " " << p.z << " " << p.word;
    const bool by_position = std::isfinite(p.x) && p.x < 1e6 && (p.x != 0 || p.z != 0);
    EXPECT_EQ(IsSeen(reader.ReadPoints({0}, {"C7"}, 100, true).frame(0).col(0)), by_position);
  }
}

TEST(HostileC3d, StartsWithZerosOrMarksAllPointsInvalid) {
  const std::string good = SmallFile();
  EXPECT_EQ(FramesRead(std::string(512, '\0') + good), 6);
  std::string file = good;
  const std::size_t data = 512 * (static_cast<unsigned char>(good[16]) - 1);
  for (int i = 0; i < 24; ++i) PutFloat(&file, data + 16 * i + 12, -1);
  EXPECT_THAT(C3dMessageOf(file), HasSubstr("ignore the marks"));
  EXPECT_EQ(ReadRecording(TempPath(), {.ignore_residuals = true}).markers.num_frames(), 6);
}

}  // namespace
}  // namespace mmm_converter
