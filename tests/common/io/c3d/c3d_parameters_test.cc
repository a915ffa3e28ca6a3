// SPDX-License-Identifier: MIT
#include "common/io/c3d/c3d_parameters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "common/io/c3d/c3d_layout.h"
#include "tests/support/c3d_bytes.h"

namespace mmm_converter {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Section = testing::C3dSection;

TEST(C3dParameters, FindsParametersThatComeBeforeTheirGroup) {
  Section section;
  section.Texts(7, "units ", 4, "mm  ").Group(7, "Point").Word(7, "FRAMES", {40000}).Append({0, 0});
  const C3dParameters parameters = section.Parse();
  EXPECT_EQ(parameters.Text("POINT", "UNITS"), "mm");
  EXPECT_EQ(parameters.Number("POINT", "FRAMES"), 40000);  // words are unsigned
  EXPECT_EQ(parameters.Number("POINT", "UNITS"), std::nullopt);
  EXPECT_EQ(parameters.Find("ANALOG", "UNITS"), nullptr);
  EXPECT_THAT(section.warnings.texts(), IsEmpty());
}

TEST(C3dParameters, ContinuesLabels) {
  Section section;
  section.Group(1, "POINT")
      .Texts(1, "LABELS2", 3, "C  ")
      .Texts(1, "LABELS", 3, std::string("A  B\0\0", 6));
  EXPECT_THAT(section.Parse().TextList("POINT", "LABELS", 10), ElementsAre("A", "B", "C"));
}

TEST(C3dParameters, GivesNoMoreTextsThanAreAskedFor) {
  Section section;
  section.Group(1, "POINT").Texts(1, "LABELS", 1, std::string(200, 'x'));
  for (int i = 2; i < 100; ++i) {
    section.Texts(1, "LABELS" + std::to_string(i), 1, std::string(200, 'x'));
  }
  std::size_t there = 0;
  EXPECT_EQ(section.Parse().TextList("POINT", "LABELS", 250, &there).size(), 250U);
  EXPECT_EQ(there, 99U * 200U);
}

// Millions of the smallest parameters would take a hundred times the file, and as many warnings.
TEST(C3dParameters, AreBounded) {
  Section section;
  section.Group(1, "POINT").Word(1, "USED", {3});
  for (int i = 0; i < 30000; ++i) section.Word(1, "U", {i % 1000});
  const C3dParameters parameters = section.Parse();
  EXPECT_EQ(parameters.all().size(), 10000U);
  EXPECT_EQ(parameters.Number("POINT", "USED"), 3);
  ASSERT_EQ(section.warnings.all().size(), 12U);
  EXPECT_EQ(section.warnings.texts()[0], "more than 10000 parameters; the others are left out");
  EXPECT_EQ(section.warnings.texts()[11], "9988 more parameters that are there twice");
}

TEST(C3dParameters, KeepsTheFirstOfEqualNames) {
  Section section;
  section.Group(1, "POINT").Word(1, "USED", {3}).Word(1, "USED", {4});
  EXPECT_EQ(section.Parse().Number("POINT", "USED"), 3);
  EXPECT_THAT(section.warnings.texts(), ElementsAre(HasSubstr("POINT:USED is there twice")));
}

TEST(C3dParameters, PassesWrongOffsetsAndSizes) {
  for (const int offset : {1, 5, 7, 0x7FFF, 0xFFF8}) {  // into itself, far beyond, -8
    Section section;
    section.Group(1, "POINT").Texts(1, "UNITS", 4, "mm  ", offset).Word(1, "USED", {3});
    const C3dParameters parameters = section.Parse();
    EXPECT_EQ(parameters.Number("POINT", "USED"), 3) << offset;
    EXPECT_EQ(parameters.Text("POINT", "UNITS"), "mm") << offset;
    EXPECT_THAT(section.warnings.texts(), Contains(HasSubstr("UNITS: the offset"))) << offset;
  }
  Section longer;  // claims 4 texts, has 2: its offset is right
  longer.Group(1, "POINT").Parameter(1, "LABELS", -1, {2, 4}, "A B ", 2 + 4 + 4 + 1);
  longer.Word(1, "USED", {3});
  const C3dParameters parameters = longer.Parse();
  EXPECT_EQ(parameters.Number("POINT", "USED"), 3);
  EXPECT_THAT(parameters.TextList("POINT", "LABELS", 10), Contains("B"));
}

TEST(C3dParameters, RefusesNonsense) {
  Section huge;
  huge.Group(1, "POINT")
      .Parameter(1, "A", 4, std::vector<int>(7, 255), "abcd", -1)
      .Word(1, "B", {1});
  EXPECT_EQ(huge.Parse().Number("POINT", "B"), 1);
  EXPECT_LE(huge.Parse().Find("POINT", "A")->size(), 2u);
  Section type;
  type.Group(1, "POINT").Parameter(1, "A", 9, {1}, "x", -1).Word(1, "B", {1});
  EXPECT_EQ(type.Parse().Number("POINT", "B"), 1);
  EXPECT_THAT(type.warnings.texts(), ElementsAre(HasSubstr("A can't be read")));
  Section name;  // length -128
  name.Word(1, "B", {1}).Append("\x80\x01" + std::string(200, 'x'));
  EXPECT_EQ(name.Parse().Number("", "B"), 1);  // an orphan
  for (const char* bytes : {"", "\x05",
                            "\x05\x01"
                            "AB",
                            "\xFF\xFF"}) {
    EXPECT_EQ(Section().Append(bytes).Parse().Find("POINT", "USED"), nullptr);
  }
}

/// Frames of a file with a header of that many, one point, room for 100000 frames.
int FramesOf(Section section, int header_frames) {
  const C3dHeader header{.points = 1,
                         .first_frame = 1,
                         .last_frame = header_frames,
                         .scale = -1,
                         .data_block = 3,
                         .rate = 100};
  Warnings warnings;
  return ResolveC3dLayout(header, section.Parse(), C3dProcessor::kIntel, 512, 1, 1024 + 16 * 100000,
                          &warnings)
      .frames;
}

TEST(C3dLayout, CountsFrames) {
  const Section point = Section().Group(1, "POINT").Group(2, "TRIAL");
  const auto with = [&] { return Section(point); };
  EXPECT_EQ(FramesOf(with(), 50), 50);
  EXPECT_EQ(FramesOf(with().Word(1, "FRAMES", {0}), 50), 50);
  EXPECT_EQ(FramesOf(with().Word(1, "FRAMES", {40000}), 50), 40000);
  EXPECT_EQ(FramesOf(with().Float(1, "FRAMES", 60), 50), 60);
  EXPECT_EQ(FramesOf(with().Float(1, "FRAMES", NAN), 50), 50);
  EXPECT_EQ(FramesOf(with().Float(1, "FRAMES", -3), 50), 50);
  EXPECT_EQ(FramesOf(with().Float(1, "FRAMES", 1e30F), 50), 50);
  EXPECT_EQ(FramesOf(with().Word(1, "FRAMES", {65535}), 65535), 100000);  // by the data's length
  EXPECT_EQ(FramesOf(with().Word(1, "FRAMES", {65535}).Float(1, "LONG_FRAMES", 70000), 65535),
            70000);
  EXPECT_EQ(FramesOf(with().Word(1, "FRAMES", {65535}).Float(1, "LONG_FRAMES", NAN), 65535),
            100000);
  EXPECT_EQ(FramesOf(with().Word(1, "FRAMES", {65535}).Float(1, "LONG_FRAMES", 4e9F), 65535),
            100000);
  EXPECT_EQ(FramesOf(with()
                         .Word(1, "FRAMES", {65535})
                         .Word(2, "ACTUAL_START_FIELD", {1, 0})
                         .Word(2, "ACTUAL_END_FIELD", {4464, 1}),  // 65536 + 4464
                     65535),
            70000);
  EXPECT_EQ(FramesOf(with()  // words that have overflown
                         .Word(1, "FRAMES", {4464})
                         .Word(2, "ACTUAL_START_FIELD", {1, 0})
                         .Word(2, "ACTUAL_END_FIELD", {4464, 1}),
                     4464),
            70000);
  EXPECT_EQ(FramesOf(with().Word(1, "FRAMES", {4464}).Float(1, "LONG_FRAMES", 70000), 4464), 70000);
  EXPECT_EQ(FramesOf(with().Word(1, "FRAMES", {34464}), 34464), 100000);
  EXPECT_EQ(FramesOf(with().Word(1, "FRAMES", {34400}), 34400), 34400);  // something follows
  EXPECT_EQ(FramesOf(with()  // of a longer trial that this was taken from
                         .Word(1, "FRAMES", {525})
                         .Word(2, "ACTUAL_START_FIELD", {1, 0})
                         .Word(2, "ACTUAL_END_FIELD", {5248, 0}),
                     525),
            525);
}

TEST(C3dLayout, FirstFrameIsTheCapturesWhereTheWordHasOverflown) {
  const auto first = [](Section section, int header_first) {
    const C3dHeader header{.points = 1,
                           .first_frame = header_first,
                           .last_frame = header_first + 9,
                           .scale = -1,
                           .data_block = 3,
                           .rate = 100};
    return ResolveC3dLayout(header, section.Parse(), C3dProcessor::kIntel, 512, 1, 1024 + 160,
                            nullptr);
  };
  const Section trial = Section().Group(2, "TRIAL");
  EXPECT_EQ(first(trial, 143).first_frame, 143);
  EXPECT_DOUBLE_EQ(first(trial, 143).first_time(100), 1.42);
  EXPECT_EQ(first(trial, 1).first_time(100), 0);
  EXPECT_EQ(first(trial, 0).first_time(100), 0);
  EXPECT_EQ(first(Section(trial).Word(2, "ACTUAL_START_FIELD", {143, 2}), 143).first_frame,
            143 + 2 * 65536);
  EXPECT_EQ(first(Section(trial).Word(2, "ACTUAL_START_FIELD", {9, 0}), 143).first_frame, 143);
}

}  // namespace
}  // namespace mmm_converter
