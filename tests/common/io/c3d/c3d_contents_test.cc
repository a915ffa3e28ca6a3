// SPDX-License-Identifier: MIT
// What a C3D file holds beside markers: analog channels, force plates, events; marks of points.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include "common/io/bytes/file_content.h"
#include "common/io/c3d/c3d_analog.h"
#include "common/io/c3d/c3d_events.h"
#include "common/io/c3d/c3d_points.h"
#include "common/io/c3d/c3d_reader.h"
#include "common/support/error.h"
#include "tests/support/c3d_bytes.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using testing::C3dBytes;
using testing::C3dSection;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::SharedData;
using ::testing::SizeIs;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

std::string WriteTemp(const std::string& content) {
  std::string path = ::testing::TempDir() + "contents_" +
                     ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".c3d";
  std::filesystem::remove(path);
  std::ofstream(path, std::ios::binary)
      .write(content.data(), static_cast<std::streamsize>(content.size()));
  return path;
}

C3dFile Open(const std::string& content) { return C3dFile(WriteTemp(content)); }

C3dSection Analog() {
  return C3dSection()
      .Group(2, "ANALOG")
      .Word(2, "USED", {2})
      .Float(2, "RATE", 1000)
      .Texts(2, "LABELS", 4, "Fz1 EMG ")
      .Texts(2, "UNITS", 2, "N mV");
}

RecordingOrigin OriginOf(C3dSection section) {
  const C3dBytes bytes = {.points = 1, .frames = {{1, 2, 3, 0}}};
  return C3dReader(WriteTemp(bytes.File(section))).info().origin;
}

TEST(C3dContents, HeightAndMassThatAreStated) {
  const auto size_of = [](const C3dSection& section) {
    const C3dBytes bytes = {.points = 1, .frames = {{1, 2, 3, 0}}};
    return C3dReader(WriteTemp(bytes.File(section))).info().stated_size;
  };
  const auto height_of = [&](const char* group, const char* name, float height) {
    return size_of(C3dSection().Group(2, group).Float(2, name, height)).height;
  };
  EXPECT_NEAR(height_of("PROCESSING", "Height", 1680).value_or(0), 1.68, 1e-6);
  EXPECT_NEAR(height_of("SUBJECT", "HEIGHT", 151).value_or(0), 1.51, 1e-6);
  EXPECT_NEAR(height_of("PATIENT", "Height", 1.63F).value_or(0), 1.63, 1e-6);
  EXPECT_FALSE(height_of("PROCESSING", "Height", 66));  // inches
  EXPECT_FALSE(height_of("PROCESSING", "Height", 0));
  EXPECT_FALSE(height_of("21989", "Height", 1050));  // of whom?
  // A subject has a group of its own.
  const BodySize child = size_of(C3dSection()
                                     .Group(2, "SUBJECTS")
                                     .Texts(2, "NAMES", 5, "21989")
                                     .Group(3, "21989")
                                     .Float(3, "Height", 1050)
                                     .Float(3, "Bodymass", 13));
  EXPECT_NEAR(child.height.value_or(0), 1.05, 1e-6);
  EXPECT_NEAR(child.mass.value_or(0), 13, 1e-6);
}

TEST(C3dContents, WhoWasRecordedWhenAndByWhat) {
  const C3dSection who = C3dSection().Group(2, "SUBJECTS").Texts(2, "NAMES", 5, "Zo\xEB  ");
  EXPECT_EQ(OriginOf(who).subject, "Zo\xC3\xAB");
  const C3dSection two = C3dSection().Group(2, "SUBJECTS").Texts(2, "NAMES", 4, "Ann Ben ");
  EXPECT_EQ(OriginOf(two).subject, "");  // whose markers these are is not said
  const auto date = [](std::initializer_list<int> words) {
    return OriginOf(C3dSection().Group(2, "TRIAL").Word(2, "DATE", words)).date;
  };
  EXPECT_EQ(date({2010, 3, 4}), "2010-03-04");
  EXPECT_EQ(date({4, 3, 2010}), "");
  EXPECT_EQ(date({2010, 3}), "");
  EXPECT_EQ(OriginOf(C3dSection().Group(2, "TRIAL").Texts(2, "DATE", 7, "4.3.10 ")).date, "4.3.10");
  const C3dSection system = C3dSection()
                                .Group(2, "MANUFACTURER")
                                .Texts(2, "COMPANY", 5, "Vicon")
                                .Texts(2, "SOFTWARE", 5, "Nexus");
  EXPECT_EQ(OriginOf(system).system, "Vicon, Nexus");
  EXPECT_EQ(OriginOf(C3dSection()).system, "");
}

TEST(C3dContents, AnalogChannels) {
  const C3dFile file = Open(C3dBytes{.analog_words = 20, .analog_samples = 10}.File(Analog()));
  Warnings warnings;
  const C3dAnalog analog = ReadC3dAnalog(file, &warnings);
  EXPECT_EQ(analog.rate, 1000);
  EXPECT_EQ(analog.samples_per_frame, 10);
  ASSERT_THAT(analog.channels, SizeIs(2));
  EXPECT_EQ(analog.channels[0].label, "Fz1");
  EXPECT_EQ(analog.channels[1].unit, "mV");
  EXPECT_THAT(warnings.texts(), IsEmpty());
}

TEST(C3dContents, AnalogChannelsWithoutParameters) {
  const C3dFile file = Open(C3dBytes{.analog_words = 6, .analog_samples = 2}.File(C3dSection()));
  Warnings warnings;
  const C3dAnalog analog = ReadC3dAnalog(file, &warnings);
  EXPECT_EQ(analog.rate, 200);  // of the header's 100 frames a second
  ASSERT_THAT(analog.channels, SizeIs(3));
  EXPECT_EQ(analog.channels[2].label, "*3");
}

TEST(C3dContents, AnalogCountsThatContradictEachOther) {
  for (const float used : {2.0F, 0.0F, -1.0F, 1e30F, kNan}) {
    const C3dSection section = C3dSection().Group(2, "ANALOG").Float(2, "USED", used);
    const C3dFile file = Open(C3dBytes{.analog_words = 20, .analog_samples = 7}.File(section));
    Warnings warnings;
    EXPECT_THAT(ReadC3dAnalog(file, &warnings).channels, SizeIs(used == 2 ? 2 : 20));
    ASSERT_FALSE(warnings.empty());
    EXPECT_THAT(warnings.texts()[0], HasSubstr("7 analog samples"));
  }
}

TEST(C3dContents, AFileWithoutPointsHasFrames) {
  const std::vector<float> frame(20, 1);
  const std::string content =
      C3dBytes{.analog_words = 20, .analog_samples = 10, .frames = {frame, frame, frame}}.File(
          Analog().Group(1, "POINT").Word(1, "FRAMES", {3}));
  C3dFile file = Open(content);
  EXPECT_EQ(file.layout().points, 0);
  EXPECT_EQ(file.layout().frames, 3);
  EXPECT_THAT(CountC3dPoints(&file), IsEmpty());
  EXPECT_THROW(C3dReader(file.path()), Error);
}

TEST(C3dContents, Events) {
  const C3dSection section = C3dSection()
                                 .Group(3, "EVENT")
                                 .Word(3, "USED", {2})
                                 .Texts(3, "LABELS", 11, "Foot StrikeFoot Off   ")
                                 .Texts(3, "CONTEXTS", 5, "Left Right")
                                 .Texts(3, "SUBJECTS", 2, "S1S1")
                                 .Floats(3, "TIMES", {2, 2}, {0, 1.5, 1, 2.25});
  std::string content = C3dBytes{.points = 1, .frames = {{1, 2, 3, 0}}}.File(section);
  content[2 * 149] = 0x39;  // 12345: labels of 4 letters
  content[2 * 149 + 1] = 0x30;
  content[2 * 150] = 1;
  const float time = 0.75;
  std::memcpy(&content[2 * 152], &time, 4);
  content.replace(2 * 198, 4, "RTO ");
  Warnings warnings;
  const std::vector<C3dEvent> events = ReadC3dEvents(Open(content), &warnings);
  ASSERT_THAT(events, SizeIs(3));
  EXPECT_EQ(events[0].label, "Foot Strike");
  EXPECT_EQ(events[0].context, "Left");
  EXPECT_EQ(events[0].time, 1.5);
  EXPECT_EQ(events[1].time, 62.25);  // a minute and 2.25 s
  EXPECT_EQ(events[1].subject, "S1");
  EXPECT_EQ(events[2].label, "RTO");
  EXPECT_EQ(events[2].time, 0.75);
  EXPECT_TRUE(events[2].is_in_header);
  EXPECT_THAT(warnings.texts(), IsEmpty());
}

TEST(C3dContents, EventsThatAreNotThere) {
  const C3dSection section = C3dSection()
                                 .Group(3, "EVENT")
                                 .Float(3, "USED", 1e30F)
                                 .Floats(3, "TIMES", {2, 2}, {0, kNan, 0, 3});
  std::string content = C3dBytes{.points = 1, .frames = {{1, 2, 3, 0}}}.File(section);
  content[2 * 150 + 1] = 77;  // events of the header: more than it can hold
  Warnings warnings;
  const std::vector<C3dEvent> events = ReadC3dEvents(Open(content), &warnings);
  ASSERT_THAT(events, SizeIs(1));
  EXPECT_EQ(events[0].time, 3);
  EXPECT_EQ(events[0].label, "");
  EXPECT_THAT(warnings.texts(), SizeIs(3));
}

TEST(C3dContents, ForcePlates) {
  std::vector<float> corners(24);
  for (int i = 0; i < 24; ++i) corners[i] = static_cast<float>(i);
  const C3dSection section = C3dSection()
                                 .Group(4, "FORCE_PLATFORM")
                                 .Word(4, "USED", {2})
                                 .Word(4, "TYPE", {2, 4})
                                 .Floats(4, "CORNERS", {3, 4, 2}, corners)
                                 .Floats(4, "ORIGIN", {3, 1}, {1, 2, 3})
                                 .Parameter(4, "CHANNEL", 1, {2, 2}, "\x01\x02\x03\x04", -1);
  Warnings warnings;
  const C3dFile file = Open(C3dBytes{.points = 1, .frames = {{1, 2, 3, 0}}}.File(section));
  const std::vector<C3dForcePlate> plates = ReadC3dForcePlates(file.parameters(), &warnings);
  ASSERT_THAT(plates, SizeIs(2));
  EXPECT_EQ(plates[0].type, 2);
  EXPECT_EQ(plates[1].type, 4);
  EXPECT_THAT(plates[1].channels, ElementsAre(3, 4));
  ASSERT_TRUE(plates[1].corners);
  EXPECT_EQ(plates[1].corners->col(3), Eigen::Vector3d(21, 22, 23));
  EXPECT_EQ(plates[0].origin, Eigen::Vector3d(1, 2, 3));
  EXPECT_FALSE(plates[1].origin);
  EXPECT_THAT(warnings.texts(), IsEmpty());
}

TEST(C3dContents, ForcePlatesThatAreNotThere) {
  const C3dSection section =
      C3dSection().Group(4, "FORCE_PLATFORM").Word(4, "USED", {65535}).Word(4, "TYPE", {3});
  Warnings warnings;
  const C3dFile file = Open(C3dBytes{.points = 1, .frames = {{1, 2, 3, 0}}}.File(section));
  const std::vector<C3dForcePlate> plates = ReadC3dForcePlates(file.parameters(), &warnings);
  ASSERT_THAT(plates, SizeIs(1));
  EXPECT_FALSE(plates[0].corners);
  EXPECT_THAT(warnings.texts(), ElementsAre(HasSubstr("65535 force plates")));
}

TEST(C3dContents, MarksOfPoints) {
  C3dFile file = Open(C3dBytes{
      .points = 1,
      .frames =
          {{1, 2, 3, 0}, {1, 2, 3, 4}, {1, 2, 3, 8}, {1, 2, 3, -1}, {0, 0, 0, 0}, {kNan, 0, 0, 0}}}
                          .File(C3dSection().Group(1, "POINT").Word(1, "FRAMES", {6})));
  const std::vector<C3dPointCounts> points = CountC3dPoints(&file);
  ASSERT_THAT(points, SizeIs(1));
  EXPECT_EQ(points[0].seen, 3);
  EXPECT_EQ(points[0].marked_invalid, 1);
  EXPECT_EQ(points[0].at_origin, 1);
  EXPECT_EQ(points[0].no_position, 1);
  EXPECT_EQ(points[0].interpolated, 1);
  EXPECT_EQ(points[0].measured, 2);
  EXPECT_EQ(points[0].residual, 6);
}

TEST(C3dContentsRealFiles, SeesWhatTheReaderSees) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  for (const char* name : {"whole_body/pycgm_movement_trial.c3d", "conformance/Eb015si.c3d",
                           "synthetic/kit53_gaps_nan_residual0.c3d"}) {
    const std::string path = SharedData(std::string("recordings/") + name);
    C3dFile file(path);
    const std::vector<C3dPointCounts> counts = CountC3dPoints(&file);
    C3dReader reader(path);
    std::vector<int> all(counts.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
    const MarkerSequence markers = reader.ReadPoints(all, reader.info().labels, 1);
    for (std::size_t i = 0; i < all.size(); ++i) {
      long seen = 0;
      for (int k = 0; k < markers.num_frames(); ++k) seen += IsSeen(markers.frame(k).col(all[i]));
      EXPECT_EQ(counts[i].seen, seen) << name << " " << reader.info().labels[i];
      const C3dPointCounts& c = counts[i];
      EXPECT_EQ(c.seen + c.marked_invalid + c.at_origin + c.no_position, markers.num_frames());
    }
  }
}

TEST(C3dContents, AnalogSamples) {
  const C3dSection section = C3dSection()
                                 .Group(2, "ANALOG")
                                 .Word(2, "USED", {2})
                                 .Float(2, "GEN_SCALE", 10)
                                 .Floats(2, "SCALE", {2}, {0.5, 2})
                                 .Word(2, "OFFSET", {1, 65534});  // 1 and -2
  C3dFile file =
      Open(C3dBytes{.points = 1,
                    .analog_words = 4,
                    .analog_samples = 2,
                    .frames = {{1, 2, 3, 0, 11, 21, 12, 22}, {1, 2, 3, 0, 13, 23, 14, 24}}}
               .File(section));
  const C3dAnalog analog = ReadC3dAnalog(file, nullptr);
  Eigen::MatrixXd expected(2, 4);
  expected << 50, 55, 60, 65, 460, 480, 500, 520;
  EXPECT_EQ(ReadC3dAnalogSamples(&file, analog), expected);
  EXPECT_EQ(analog.rate, 200);
}

TEST(C3dContents, AnalogSamplesWithoutScales) {
  C3dFile file = Open(C3dBytes{.analog_words = 1, .frames = {{3}, {4}}}.File(C3dSection()));
  EXPECT_EQ(ReadC3dAnalogSamples(&file, ReadC3dAnalog(file, nullptr)), Eigen::RowVector2d(3, 4));
  C3dFile none = Open(C3dBytes{.points = 1, .frames = {{1, 2, 3, 0}}}.File(C3dSection()));
  EXPECT_EQ(ReadC3dAnalogSamples(&none, ReadC3dAnalog(none, nullptr)).size(), 0);
}

// The same trial as its maker stored it, in floats and in words, for two processors.
TEST(C3dContentsRealFiles, AnalogSamplesAreTheSameHoweverStored) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const auto read = [](const char* name) {
    C3dFile file(SharedData(std::string("recordings/conformance/") + name));
    return ReadC3dAnalogSamples(&file, ReadC3dAnalog(file, nullptr));
  };
  const Eigen::MatrixXd floats = read("Eb015pr.c3d");
  ASSERT_GT(floats.cwiseAbs().maxCoeff(), 100);
  for (const char* name : {"Eb015pi.c3d", "Eb015si.c3d"}) {
    const Eigen::MatrixXd samples = read(name);
    ASSERT_EQ(samples.cols(), floats.cols()) << name;
    // Rounding of the scales, which are floats.
    EXPECT_LT((samples - floats).cwiseAbs().maxCoeff(), 1e-5 * floats.cwiseAbs().maxCoeff())
        << name;
  }
}

TEST(C3dContentsRealFiles, RealFiles) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const struct {
    const char* name;
    std::size_t channels;
    int samples;
    std::size_t plates;
    std::size_t events;
  } files[] = {{"forces/walking2.c3d", 12, 8, 2, 0},
               {"recordings/whole_body/pycgm_movement_trial.c3d", 69, 9, 4, 0},
               {"recordings/conformance/Eb015pr.c3d", 16, 4, 2, 3},
               {"recordings/conformance/Eb015si.c3d", 16, 4, 2, 3},
               {"recordings/whole_body/85_02.c3d", 0, 0, 0, 0}};
  for (const auto& expected : files) {
    SCOPED_TRACE(expected.name);
    const C3dFile file(SharedData(expected.name));
    Warnings warnings;
    const C3dAnalog analog = ReadC3dAnalog(file, &warnings);
    EXPECT_THAT(analog.channels, SizeIs(expected.channels));
    EXPECT_EQ(analog.samples_per_frame, expected.samples);
    EXPECT_EQ(analog.rate, expected.samples * file.layout().rate);
    EXPECT_THAT(ReadC3dForcePlates(file.parameters(), &warnings), SizeIs(expected.plates));
    EXPECT_THAT(ReadC3dEvents(file, &warnings), SizeIs(expected.events));
    EXPECT_THAT(warnings.texts(), IsEmpty());
  }
}

TEST(C3dContents, FlippedBytes) {
  std::vector<float> corners(12, 1);
  const std::string good = C3dBytes{.points = 1,
                                    .analog_words = 4,
                                    .analog_samples = 2,
                                    .frames = {{1, 2, 3, 0, 1, 1, 1, 1}, {1, 2, 3, 0, 1, 1, 1, 1}}}
                               .File(Analog()
                                         .Group(3, "EVENT")
                                         .Word(3, "USED", {1})
                                         .Texts(3, "LABELS", 4, "FOOT")
                                         .Floats(3, "TIMES", {2, 1}, {0, 1})
                                         .Group(4, "FORCE_PLATFORM")
                                         .Word(4, "USED", {1})
                                         .Floats(4, "CORNERS", {3, 4, 1}, corners)
                                         .Parameter(4, "CHANNEL", 1, {2, 1}, "\x01\x02", -1));
  std::mt19937 generator(3);
  int read = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    std::string broken = good;
    for (int i = 0; i <= trial % 4; ++i) {
      broken[generator() % 1024] = static_cast<char>(generator());
    }
    try {
      C3dFile file = Open(broken);
      Warnings warnings;
      ReadC3dAnalogSamples(&file, ReadC3dAnalog(file, &warnings));
      ReadC3dEvents(file, &warnings);
      ReadC3dForcePlates(file.parameters(), &warnings);
      CountC3dPoints(&file);
      ++read;
    } catch (const Error&) {
    }
  }
  EXPECT_GT(read, 1000);  // most bytes do not matter
}

}  // namespace
}  // namespace mmm_converter
