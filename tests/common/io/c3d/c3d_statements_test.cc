// SPDX-License-Identifier: MIT
// What places of a C3D file say of its sizes and times, and which of them counts.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "common/io/c3d/c3d_analog.h"
#include "common/io/c3d/c3d_events.h"
#include "common/io/c3d/c3d_reader.h"
#include "common/support/error.h"
#include "tests/support/c3d_bytes.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using testing::C3dBytes;
using testing::C3dSection;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

std::string WriteStated(const std::string& content) {
  std::string path = testing::TestFolder() + "/statements.c3d";
  std::filesystem::remove(path);
  std::ofstream(path, std::ios::binary)
      .write(content.data(), static_cast<std::streamsize>(content.size()));
  return path;
}

C3dFile OpenStated(const std::string& content) { return C3dFile(WriteStated(content)); }

/// A file of five points in 200 frames, of which coordinate x of point p in frame k is 100 k + p.
std::string WithAnalog(int channels, int samples, int header_words, int header_samples,
                       const C3dSection& section) {
  C3dBytes bytes{.points = 5, .analog_words = header_words, .analog_samples = header_samples};
  for (int k = 0; k < 200; ++k) {
    std::vector<float> frame;
    for (int p = 0; p < 5; ++p) {
      for (const float number :
           {100.0F * static_cast<float>(k) + static_cast<float>(p), 2.0F, 3.0F, 0.0F}) {
        frame.push_back(number);
      }
    }
    for (int i = 0; i < channels * samples; ++i) frame.push_back(static_cast<float>(7 * k + i));
    bytes.frames.push_back(frame);
  }
  std::string file = bytes.File(section);
  file.resize((file.size() + 511) / 512 * 512);
  return file;
}

// The header's word 3 is wrong in each of these; the length of the data tells.
TEST(C3dStatements, TheDatasLengthTellsHowManyAnalogSamplesThereAre) {
  const auto section = [](float used, float rate) {
    return C3dSection()
        .Group(1, "POINT")
        .Word(1, "FRAMES", {200})
        .Float(1, "RATE", 100)
        .Group(2, "ANALOG")
        .Float(2, "USED", used)
        .Float(2, "RATE", rate);
  };
  struct {
    int header_words, header_samples;
    float used, rate;
  } const cases[] = {{4, 7, 4, 700},  // channels rather than samples
                     {4, 1, 4, 700},  // by the rates
                     {0, 0, 4, 0},    // by the room alone
                     {28, 7, 3, 100},
                     {28, 0, 0, 0}};
  for (const auto& one : cases) {
    C3dFile file = OpenStated(
        WithAnalog(4, 7, one.header_words, one.header_samples, section(one.used, one.rate)));
    ASSERT_EQ(file.layout().analog_words, 28) << one.header_words;
    C3dReader reader(file.path());
    const MarkerSequence markers = reader.ReadPoints({4}, {"E"}, 100);
    ASSERT_EQ(markers.num_frames(), 200);
    EXPECT_EQ(markers.frame(199)(0, 0), 19904);
    if (one.used != 4) continue;
    const C3dAnalog analog = ReadC3dAnalog(file, nullptr);
    EXPECT_THAT(analog.channels, SizeIs(4));
    EXPECT_EQ(analog.samples_per_frame, 7);
    EXPECT_EQ(ReadC3dAnalogSamples(&file, analog)(3, 7 * 199 + 6), 7 * 199 + 27);
  }
  Warnings warnings;
  const C3dFile file(WriteStated(WithAnalog(4, 7, 4, 7, section(4, 700))), &warnings);
  EXPECT_THAT(warnings.texts(), ElementsAre(HasSubstr("4 analog samples in a frame; the data's "
                                                      "length and ANALOG say 28")));
}

TEST(C3dStatements, AFileOfRotationsSaysSo) {
  const C3dSection section = C3dSection()
                                 .Group(1, "POINT")
                                 .Word(1, "FRAMES", {2})
                                 .Group(3, "ROTATION")
                                 .Word(3, "USED", {19});
  const std::string path = WriteStated(C3dBytes{}.File(section) + std::string(1024, '\0'));
  try {
    const C3dReader reader(path);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("the rotations of 19 segments and no points"));
    EXPECT_THAT(error.what(), HasSubstr("export points too"));
  }
}

TEST(C3dStatements, EventsAreOnTheTimeBaseOfTheMarkers) {
  const std::vector<std::vector<float>> frames(120, std::vector<float>{1, 2, 3, 0});
  const auto time_of = [&](float stored) {
    const C3dSection section = C3dSection()
                                   .Group(1, "POINT")
                                   .Word(1, "FRAMES", {120})
                                   .Float(1, "RATE", 100)
                                   .Group(2, "EVENT")
                                   .Word(2, "USED", {1})
                                   .Floats(2, "TIMES", {2, 1}, {0, stored});
    const C3dFile file =
        OpenStated(C3dBytes{.points = 1, .first_frame = 143, .frames = frames}.File(section));
    return ReadC3dEvents(file, nullptr).at(0).time;
  };
  EXPECT_NEAR(time_of(1.62F), 1.62, 1e-6);  // frame 163 of the capture, 20 of the file
  EXPECT_NEAR(time_of(0.2F), 1.62, 1e-6);   // counted from the first stored frame
  EXPECT_NEAR(time_of(9), 9, 1e-6);         // of neither
}

}  // namespace
}  // namespace mmm_converter
