// SPDX-License-Identifier: MIT
#include "common/io/c3d/c3d_relabelling.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "common/io/bytes/file_content.h"
#include "common/io/c3d/c3d_file.h"
#include "common/io/c3d/c3d_reader.h"
#include "common/support/atomic_file.h"
#include "common/support/error.h"
#include "common/support/units.h"
#include "tests/support/c3d_bytes.h"
#include "tests/support/shared_data.h"
#include "tests/support/strict_c3d.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;
using testing::C3dBytes;
using testing::C3dSection;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::ReadStrictC3d;
using testing::StrictC3d;

using Points = std::vector<C3dRelabelledPoint>;

std::string Output() { return testing::TestFolder() + "/out.c3d"; }

std::string Written(const std::string& input, const Points& points) {
  WriteRelabelledC3d(input, points, Output());
  return ReadFileContent(Output());
}

Points Unchanged(const std::string& input) {
  const C3dFile file(input);
  const std::vector<std::string> names = C3dPointNames(file, nullptr);
  Points points;
  for (int i = 0; i < file.layout().points; ++i) {
    points.push_back({names[i], i, {{0, file.layout().frames, i}}});
  }
  return points;
}

std::vector<std::string> RealFiles() {
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(testing::SharedData(""))) {
    if (entry.path().extension() != ".c3d") continue;
    try {
      const C3dReader reader(entry.path().string());
      files.push_back(entry.path().string());
    } catch (const Error&) {  // what is no recording of points
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(C3dRelabellingRealFiles, WhatChangesNothingGivesTheSameBytes) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::vector<std::string> files = RealFiles();
  EXPECT_GE(files.size(), 30);
  for (const std::string& file : files) {
    EXPECT_TRUE(Written(file, Unchanged(file)) == ReadFileContent(file)) << file;
  }
}

bool IsOfPoints(const std::string& name) {
  return name.starts_with("POINT:LABELS") || name.starts_with("POINT:DESCRIPTIONS");
}

// Everything but points, their number and where the data start.
void ExpectTheRestKept(const StrictC3d& before, const StrictC3d& after) {
  EXPECT_EQ(after.analog, before.analog);
  for (const auto& [name, content] : before.records) {
    if (IsOfPoints(name) || name == "POINT:USED" || name == "POINT:DATA_START") continue;
    EXPECT_TRUE(after.records.contains(name) && after.records.at(name) == content) << name;
  }
  std::vector<std::string> order = after.order;
  std::erase_if(order, [&](const std::string& name) { return !before.records.contains(name); });
  EXPECT_EQ(order, before.order);
  for (std::size_t i = 0; i < before.header.size(); ++i) {
    const std::size_t word = i / 2 + 1;
    if (word == 2 || word == 9) continue;
    EXPECT_EQ(after.header[i], before.header[i]) << "header word " << word;
  }
}

// Points in the opposite order, every third of them under a name that needs more room.
TEST(C3dRelabellingRealFiles, PointsOfRealFilesInAnotherOrder) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  int files = 0;
  for (const std::string& file : RealFiles()) {
    StrictC3d before;
    try {
      before = ReadStrictC3d(ReadFileContent(file));
    } catch (const std::runtime_error&) {  // not every real file is by the book
      continue;
    }
    if (before.labels.size() != static_cast<std::size_t>(before.points)) continue;
    SCOPED_TRACE(file);
    ++files;
    Points points = Unchanged(file);
    std::reverse(points.begin(), points.end());
    for (std::size_t i = 0; i < points.size(); i += 3) {
      points[i].label = "quite_a_long_name_of_a_marker_" + std::to_string(i);
    }
    const StrictC3d after = ReadStrictC3d(Written(file, points));
    ExpectTheRestKept(before, after);
    EXPECT_EQ(after.behind, before.behind);
    ASSERT_EQ(after.points, before.points);
    const C3dReader reader(Output());
    for (int i = 0; i < after.points; ++i) {
      const int from = before.points - 1 - i;
      EXPECT_EQ(after.labels[i], i % 3 == 0 ? points[i].label : before.labels[from]);
      EXPECT_EQ(reader.info().labels[i], points[i].label);
      for (int k = 0; k < before.frames; ++k) {
        ASSERT_TRUE(after.words[k][i] == before.words[k][from]) << k << " " << i;
      }
    }
  }
  EXPECT_GE(files, 20);
}

TEST(C3dRelabellingRealFiles, EventsAreWrittenAndTheRestKept) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  int files = 0;
  for (const std::string& file : RealFiles()) {
    StrictC3d before;
    try {
      before = ReadStrictC3d(ReadFileContent(file));
    } catch (const std::runtime_error&) {
      continue;
    }
    SCOPED_TRACE(file);
    ++files;
    const C3dLayout layout = C3dFile(file).layout();
    const double first = layout.first_time(layout.rate);
    const std::vector<C3dEvent> events = {
        {first, "Foot Strike", "Left", "Anna", false},
        {first + 0.5 / layout.rate, "Foot Off", "Right", "", false}};
    WriteC3dWithEvents(file, events, Output());
    const StrictC3d after = ReadStrictC3d(ReadFileContent(Output()));
    std::erase_if(before.records, [](const auto& one) { return one.first.starts_with("EVENT:"); });
    std::erase_if(before.order, [](const auto& one) { return one.starts_with("EVENT:"); });
    ExpectTheRestKept(before, after);
    EXPECT_EQ(after.words, before.words);
    EXPECT_EQ(after.behind, before.behind);
    std::vector<C3dEvent> read = ReadC3dEvents(C3dFile(Output()), nullptr);
    std::erase_if(read, [](const C3dEvent& one) { return one.is_in_header; });
    ASSERT_EQ(read.size(), events.size());
    for (std::size_t i = 0; i < events.size(); ++i) {
      EXPECT_NEAR(read[i].time, events[i].time, 1e-5);
      EXPECT_EQ(read[i].label, events[i].label);
      EXPECT_EQ(read[i].context, events[i].context);
      EXPECT_EQ(read[i].subject, events[i].subject);
    }
  }
  EXPECT_GE(files, 20);
}

// Half of the first point under a name of its own, the other half goes on as the second's, which
// ends there; the third is left out.
TEST(C3dRelabellingRealFiles, OtherNumbersOfPointsForEveryProcessor) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  for (const std::string name :
       {"intel_float", "intel_int", "dec_float", "dec_int", "mips_float", "mips_int"}) {
    SCOPED_TRACE(name);
    const std::string file = testing::SharedData("recordings/synthetic/kit53_" + name + ".c3d");
    C3dReader original(file);
    const int frames = original.info().layout.frames;
    const StrictC3d before = ReadStrictC3d(ReadFileContent(file));
    Points points = Unchanged(file);
    points[0].stretches = {{0, 10, 0}};
    points[1].stretches = {{0, 10, 1}, {10, frames, 0}};
    points.erase(points.begin() + 2);
    for (int extra = 0; extra < 2; ++extra) {
      const StrictC3d after = ReadStrictC3d(Written(file, points));
      ExpectTheRestKept(before, after);
      EXPECT_EQ(after.words[10][1], before.words[10][0]);
      EXPECT_EQ(after.words[9][1], before.words[9][1]);
      EXPECT_EQ(after.words[frames - 1].size(), points.size());
      C3dReader reader(Output());
      EXPECT_EQ(reader.info().layout.frames, frames);
      EXPECT_EQ(reader.info().labels.size(), points.size());
      EXPECT_TRUE(reader.ReadFrame(9)[0].valid);
      EXPECT_FALSE(reader.ReadFrame(10)[0].valid);
      EXPECT_EQ(reader.ReadFrame(frames - 1)[1].position,
                original.ReadFrame(frames - 1)[0].position);
      // Then with more points than there were.
      for (int i = 0; i < 5; ++i) points.push_back({"*" + std::to_string(i + 1), 2, {}});
    }
  }
}

// Results stand behind the points, in the file's own unit and list; where they are not known they
// are marked invalid.
TEST(C3dRelabellingRealFiles, ResultsAreWrittenAndTheRestKept) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  for (const std::string name :
       {"intel_float", "intel_int", "dec_float", "dec_int", "mips_float", "mips_int"}) {
    SCOPED_TRACE(name);
    const std::string file = testing::SharedData("recordings/synthetic/kit53_" + name + ".c3d");
    const StrictC3d before = ReadStrictC3d(ReadFileContent(file));
    Eigen::Matrix3Xd values(3, 3);
    values << 10, kNaN, -7, 20, 2, -8, 30, 3, -9;
    const std::string taken = before.labels.front();
    WriteC3dWithResults(file,
                        {{taken, C3dResultKind::kAngle, -1, values},
                         {"LHipMoment", C3dResultKind::kMoment, 4, values / 100},
                         {"LHipPower", C3dResultKind::kPower, 4, values}},
                        {{0.5, "Foot Strike", "Left", "", false}}, Output());
    const StrictC3d after = ReadStrictC3d(ReadFileContent(Output()));
    EXPECT_EQ(after.analog, before.analog);
    EXPECT_EQ(after.points, before.points + 3);
    for (int k = 0; k < before.frames; ++k) {
      const std::vector<std::string> words(after.words[k].begin(), after.words[k].end() - 3);
      ASSERT_EQ(words, before.words[k]);
    }
    C3dReader reader(Output());
    const std::size_t first = before.labels.size();
    const auto value = [&](int frame, std::size_t i) {
      return reader.ReadFrame(frame)[first + i].position;
    };
    const double step = reader.info().layout.scale;
    EXPECT_FALSE(reader.ReadFrame(0)[first].valid);
    EXPECT_LT((value(1, 0) - Eigen::Vector3d(-7, -8, -9)).norm(), step);
    EXPECT_FALSE(reader.ReadFrame(2)[first].valid);
    EXPECT_LT((value(4, 1) - Eigen::Vector3d(100, 200, 300)).norm(), step);
    EXPECT_LT((value(6, 2) - Eigen::Vector3d(-7, -8, -9)).norm(), step);
    const C3dFile written(Output());
    const C3dParameters& parameters = written.parameters();
    EXPECT_EQ(after.labels[first], taken + "_MMM");
    EXPECT_EQ(parameters.Text("POINT", "ANGLES"), taken + "_MMM");
    EXPECT_EQ(parameters.Text("POINT", "ANGLE_UNITS"), "deg");
    EXPECT_EQ(parameters.Text("POINT", "MOMENT_UNITS"), "Nmm/kg");
    EXPECT_EQ(parameters.Text("POINT", "POWERS"), "LHipPower");
    EXPECT_EQ(ReadC3dEvents(C3dFile(Output()), nullptr).size(), 1);
  }
}

TEST(C3dRelabellingRealFiles, ResultsThatIntegersCannotHoldAreHiddenOrRefused) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string file = testing::SharedData("recordings/synthetic/kit53_intel_int.c3d");
  const double most = 32767 * C3dFile(file).layout().scale / 1000;
  const auto moment = [](double value) -> std::vector<C3dResult> {
    return {{"LHipMoment", C3dResultKind::kMoment, 0, Eigen::Matrix3Xd::Constant(3, 1, value)}};
  };
  CheckC3dResults(file, moment(0.99 * most), {});
  EXPECT_THROW(CheckC3dResults(file, moment(1.01 * most), {}), Error);
  std::vector<C3dResult> results = moment(0.99 * most);
  EXPECT_THAT(HideUnstorable(C3dFile(file), &results), IsEmpty());
  results[0].values.conservativeResize(3, 2);
  results[0].values.col(1) << 0, 1.01 * most, 0;
  EXPECT_THAT(HideUnstorable(C3dFile(file), &results), ElementsAre("LHipMoment in 1 frame"));
  EXPECT_TRUE(results[0].values.col(0).allFinite() && results[0].values.col(1).hasNaN());
  CheckC3dResults(file, results, {});
  const std::vector<C3dEvent> events(256);
  EXPECT_THROW(CheckC3dResults(file, {}, events), Error);
  EXPECT_THROW(WriteC3dWithResults(file, moment(-1.01 * most), {}, Output()), Error);
  EXPECT_FALSE(fs::exists(Output()));
}

/// Two points, an analog channel with two samples a frame, three frames.
C3dSection SmallSection() {
  C3dSection section;
  section.Group(1, "POINT").Word(1, "USED", {2}).Word(1, "DATA_START", {3});
  section.Texts(1, "LABELS", 4, "A   BB  ").Texts(1, "DESCRIPTIONS", 5, "firstsecnd");
  return section.Group(2, "ANALOG").Word(2, "USED", {1});
}

std::string SmallFile(const C3dSection& section) {
  C3dBytes bytes{.points = 2, .analog_words = 2, .analog_samples = 2};
  for (int k = 0; k < 3; ++k) {
    const auto t = static_cast<float>(k);
    bytes.frames.push_back({1 + t, 2, 3, 256, 4 + t, 5, 6, 0, 100 + t, 200 + t});
  }
  std::string path = testing::TestFolder() + "/small.c3d";
  WriteFileAtomically(path, bytes.File(section));
  return path;
}

TEST(C3dRelabelling, WhatIsNotSeenIsMarkedInvalid) {
  const std::string file = SmallFile(SmallSection());
  const StrictC3d after = ReadStrictC3d(
      Written(file, {{"B", 1, {{1, 2, 0}}}, {"*1", 0, {{0, 1, 0}, {2, 3, 0}}}, {"BB", 1, {}}}));
  EXPECT_THAT(after.labels, ElementsAre("B", "*1", "BB"));
  EXPECT_THAT(after.descriptions, ElementsAre("secnd", "first", "secnd"));
  const std::string unseen = C3dSection::BytesOf({0, 0, 0, -1});
  EXPECT_EQ(after.words[0][0], unseen);
  EXPECT_EQ(after.words[1][0], C3dSection::BytesOf({2, 2, 3, 256}));
  EXPECT_EQ(after.words[1][1], unseen);
  EXPECT_EQ(after.words[2][1], C3dSection::BytesOf({3, 2, 3, 256}));
  EXPECT_EQ(after.words[2][2], unseen);
  EXPECT_EQ(after.analog[2], C3dSection::BytesOf({102, 202}));
}

TEST(C3dRelabelling, TheInputCanBeTheOutput) {
  const std::string file = SmallFile(SmallSection());
  const std::string before = ReadFileContent(file);
  WriteRelabelledC3d(file, {{"BB", 1, {{0, 3, 0}}}, {"A", 0, {{0, 3, 1}}}}, file);
  const StrictC3d after = ReadStrictC3d(ReadFileContent(file));
  EXPECT_EQ(after.words[0][0], ReadStrictC3d(before).words[0][0]);
  EXPECT_THAT(after.labels, ElementsAre("BB", "A"));
}

TEST(C3dRelabelling, AFileHoldsAsManyEventsAsAByteCounts) {
  const std::string file = SmallFile(SmallSection());
  WriteC3dWithEvents(file, std::vector<C3dEvent>(255, {61.5, "Foot Off", "Left", "", false}), file);
  const std::vector<C3dEvent> events = ReadC3dEvents(C3dFile(file), nullptr);
  ASSERT_EQ(events.size(), 255);
  EXPECT_NEAR(events.back().time, 61.5, 1e-5);
  EXPECT_THROW(WriteC3dWithEvents(file, std::vector<C3dEvent>(256), file), Error);
  EXPECT_EQ(ReadC3dEvents(C3dFile(file), nullptr).size(), 255);
}

TEST(C3dRelabelling, LabelsAreAddedWhereThereAreNone) {
  C3dSection section;
  section.Group(1, "POINT").Word(1, "USED", {2}).Word(1, "DATA_START", {3});
  const std::string file = SmallFile(section);
  const StrictC3d after =
      ReadStrictC3d(Written(file, {{"LFHD", 0, {{0, 3, 0}}}, {"*2", 1, {{0, 3, 1}}}}));
  EXPECT_THAT(after.labels, ElementsAre("LFHD", "*2"));
  ExpectTheRestKept(ReadStrictC3d(ReadFileContent(file)), after);
}

TEST(C3dRelabelling, LabelsAreAddedWhereNoParameterIsThere) {
  const C3dSection other = C3dSection().Group(127, "NOTES").Texts(127, "A", 2, "hi");
  const C3dSection none;
  for (const C3dSection* const one : {&none, &other}) {
    const C3dSection& section = *one;
    const std::string file = SmallFile(section);
    Written(file, {{"LKNE", 0, {{0, 3, 0}}}, {"RKNE", 1, {{0, 3, 1}}}});
    Warnings warnings;
    C3dReader after(Output(), &warnings);
    EXPECT_THAT(warnings.texts(), IsEmpty());
    EXPECT_THAT(after.info().labels, ElementsAre("LKNE", "RKNE"));
    EXPECT_EQ(after.ReadFrame(2)[0].position, Eigen::Vector3d(3, 2, 3));
    EXPECT_EQ(after.ReadFrame(2)[1].position, Eigen::Vector3d(6, 5, 6));
    const C3dFile stored(Output());
    EXPECT_EQ(stored.parameters().Text("NOTES", "A"), &section == &other ? "hi" : "");
  }
}

TEST(C3dRelabelling, MoreLabelsThanAListHolds) {
  const std::string file = SmallFile(SmallSection());
  Points points;
  for (int i = 0; i < 700; ++i) {
    points.push_back({"a_label_of_some_length_" + std::to_string(i), i % 2, {{0, 3, i % 2}}});
  }
  const StrictC3d after = ReadStrictC3d(Written(file, points));
  ASSERT_EQ(after.labels.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(after.labels[i], points[i].label);
  EXPECT_GT(after.data_block, 3);
  EXPECT_EQ(after.analog, ReadStrictC3d(ReadFileContent(file)).analog);
  EXPECT_EQ(C3dReader(Output()).info().labels.back(), points.back().label);
}

TEST(C3dRelabelling, LabelsInUtf8AreWrittenAsTheyAre) {
  const std::string file = SmallFile(SmallSection());
  const std::string name = "Schädel_links_头";
  Written(file, {{name, 0, {{0, 3, 0}}}});
  EXPECT_THAT(C3dReader(Output()).info().labels, ElementsAre(name));
}

TEST(C3dRelabelling, PointersToBlocksMove) {
  C3dSection section = SmallSection();
  section.Group(3, "ROTATION").Word(3, "DATA_START", {4});
  C3dBytes bytes{.points = 2, .analog_words = 2, .analog_samples = 2};
  bytes.frames.assign(3, {1, 2, 3, 0, 4, 5, 6, 0, 100, 200});
  std::string content = bytes.File(section);
  content.resize(3 * 512, '\0');
  content += std::string(512, 'R');
  const std::string file = testing::TestFolder() + "/rotation.c3d";
  WriteFileAtomically(file, content);
  Points points;
  for (int i = 0; i < 40; ++i) points.push_back({"name" + std::to_string(i), 0, {{0, 3, 0}}});
  const std::string out = Written(file, points);
  const StrictC3d after = ReadStrictC3d(out);
  const std::string& record = after.records.at("ROTATION:DATA_START");
  const std::size_t block = static_cast<unsigned char>(record[record.size() - 3]);
  EXPECT_GT(block, 4);
  EXPECT_EQ(out.substr(512 * (block - 1)), std::string(512, 'R'));
}

std::string RelabelError(const std::string& file, const Points& points) {
  try {
    WriteRelabelledC3d(file, points, Output());
  } catch (const Error& error) {
    EXPECT_FALSE(fs::exists(Output()));
    return error.what();
  }
  return "no error";
}

TEST(C3dRelabelling, WhatTheFormatCantHold) {
  const std::string file = SmallFile(SmallSection());
  std::string own_header = ReadFileContent(file);
  own_header[0] = 1;  // as if the parameters were the header
  own_header[3] = 84;
  WriteFileAtomically(testing::TestFolder() + "/block1.c3d", own_header);
  EXPECT_THAT(RelabelError(testing::TestFolder() + "/block1.c3d", {{"a", 0, {}}}),
              HasSubstr("not between header and data"));
  EXPECT_THAT(RelabelError(file, {}), HasSubstr("small.c3d: can't be written with other points"));
  EXPECT_THAT(RelabelError(file, {{std::string(128, 'a'), 0, {}}}),
              HasSubstr("has more than 127 bytes"));
  EXPECT_THAT(RelabelError(file, Points(65536, {"a", 0, {}})), HasSubstr("at most 65535 fit"));
  EXPECT_THAT(RelabelError(file, Points(2000, {std::string(120, 'a'), 0, {}})),
              HasSubstr("blocks; at most 255 fit"));
}

}  // namespace
}  // namespace mmm_converter
