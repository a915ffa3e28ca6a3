// SPDX-License-Identifier: MIT
#include "common/pipeline/conversion_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace mmm_converter {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// The row of this name, of the request's table.
Option RowOf(ConversionRequest* request, const std::string& name) {
  for (const Option& option : Options(request)) {
    if (LongName(option) == name) return option;
  }
  ADD_FAILURE() << name;
  return {};
}

std::string TakeOne(const std::string& name, const std::string& value, ConversionRequest* request,
                    double unit = 1) {
  return SetOption(RowOf(request, name), {value}, unit);
}

TEST(Options, EveryMediumHasEachOrItSaysWhyNot) {
  for (const Option& option : DescribedOptions()) {
    SCOPED_TRACE(std::string(option.names.line) + option.names.keyword);
    const auto [line, attribute, keyword] = option.names;
    const bool is_everywhere = *line != 0 && *attribute != 0 && *keyword != 0;
    EXPECT_EQ(is_everywhere, *option.notes.absent == 0);
    // Who reads a command line may keep for himself what only that has.
    const bool is_shared = *attribute != 0 || *keyword != 0;
    EXPECT_FALSE(is_shared && std::holds_alternative<std::monostate>(option.to));
    EXPECT_NE(*option.help, 0);
    EXPECT_NE(option.tasks, 0U);
    // What a length's attribute is given in stands in its name.
    if (std::string(option.value.unit) == "metres") {
      EXPECT_TRUE(std::string(attribute).ends_with("m")) << attribute;
    }
  }
}

TEST(Options, NamesAreThereOnce) {
  std::set<std::string> lines, attributes, keywords;
  for (const Option& option : DescribedOptions()) {
    const auto is_new = [](const char* name, std::set<std::string>* known) {
      return *name == 0 || known->insert(name).second;
    };
    EXPECT_TRUE(is_new(option.names.line, &lines)) << option.names.line;
    EXPECT_TRUE(is_new(option.names.attribute, &attributes)) << option.names.attribute;
    EXPECT_TRUE(is_new(option.names.keyword, &keywords)) << option.names.keyword;
  }
}

TEST(Options, AnotherIsNamedAsTheMediumCallsIt) {
  for (const Option& option : DescribedOptions()) {
    for (const Medium medium : {Medium::kCommandLine, Medium::kManifest, Medium::kPython}) {
      EXPECT_THAT(Spell(medium, option.help, DescribedOptions()), Not(HasSubstr("{")));
    }
  }
  const auto spell = [](Medium medium) {
    return Spell(medium, "{subject-file}, {marker-set}", DescribedOptions());
  };
  EXPECT_EQ(spell(Medium::kCommandLine), "--subject-file, --marker-set");
  EXPECT_EQ(spell(Medium::kManifest), "subjectFile, markerSet");
  EXPECT_EQ(spell(Medium::kPython), "subject, marker_set");
}

TEST(Options, ValuesGoToTheRequest) {
  ConversionRequest request;
  EXPECT_EQ(TakeOne("height", "1.75", &request), "");
  EXPECT_EQ(TakeOne("hand-length", "180", &request, 1e-3), "");
  EXPECT_EQ(TakeOne("unit", "in", &request), "");
  EXPECT_EQ(TakeOne("up", "-Y", &request), "");
  EXPECT_EQ(TakeOne("frames", "10:", &request), "");
  EXPECT_EQ(TakeOne("motion", "walk", &request), "");
  EXPECT_EQ(TakeOne("self-calibrate", "true", &request), "");
  EXPECT_EQ(SetOption(RowOf(&request, "and-subject-file"), {"a.xml", "b.xml"}), "");
  EXPECT_EQ(request.input.person.size.height, 1.75);
  EXPECT_EQ(request.input.person.size.hand_length, 180 * 1e-3);
  EXPECT_EQ(request.input.reading.unit, "in");
  EXPECT_EQ(request.input.reading.up_axis, UpAxis::kMinusY);
  EXPECT_EQ(request.input.first_frame, 10);
  EXPECT_FALSE(request.input.end_frame.has_value());
  EXPECT_EQ(request.input.reading.motion, "walk");
  EXPECT_EQ(request.motion_name, "walk");
  EXPECT_TRUE(request.self_calibrate);
  EXPECT_EQ(request.label_hints.other_persons, (std::vector<std::string>{"a.xml", "b.xml"}));
}

TEST(Options, WhatIsNotAllowedSaysWhatIs) {
  ConversionRequest request;
  EXPECT_EQ(TakeOne("height", "175", &request), "give metres from 0.5 to 2.5");
  EXPECT_EQ(TakeOne("height", "nan", &request), "give metres from 0.5 to 2.5");
  EXPECT_EQ(TakeOne("hand-length", "0.18", &request, 1e-3), "give millimetres from 50 to 400");
  EXPECT_EQ(TakeOne("unit", "ft", &request), "use mm, cm, m or in");
  EXPECT_EQ(TakeOne("format", "3.0", &request), "use 2.0 or 1.0");
  EXPECT_EQ(TakeOne("up", "w", &request), "use x, y, z, -x, -y or -z");
  EXPECT_EQ(TakeOne("label", "yes", &request), "use true, repair or false");
  for (const char* frames : {"5", "1-5", "-5:9", ":x", "99999999999:"}) {
    EXPECT_THAT(TakeOne("frames", frames, &request), HasSubstr("use A:B")) << frames;
  }
}

TEST(Options, WhatExcludesEachOtherIsSaid) {
  ConversionRequest request;
  EXPECT_EQ(Contradiction(request), "");
  request.label_hints.like = "a.c3d";
  EXPECT_THAT(Contradiction(request), HasSubstr("like says by"));
  TakeOne("repair", "true", &request);
  EXPECT_EQ(Contradiction(request), "");
  request.is_object = true;
  EXPECT_THAT(Contradiction(request), HasSubstr("not those of an object"));
  request.is_object = false;
  request.self_calibrate = true;
  request.input.person.subject_file = "anna.xml";
  EXPECT_THAT(Contradiction(request), HasSubstr("use one"));
}

TEST(Options, AdviceIsInTheMediumsOwnWords) {
  EXPECT_EQ(ExampleOf(Medium::kManifest, Remedy::kHeight), "height_m=\"1.75\"");
  EXPECT_EQ(ExampleOf(Medium::kManifest, Remedy::kIgnoreResiduals), "ignoreResiduals=\"true\"");
  EXPECT_EQ(ExampleOf(Medium::kManifest, Remedy::kLabels), "");
  const Wording line = WordingOf(Medium::kCommandLine);
  EXPECT_EQ(line.option("subject-file"), "--subject-file");
  EXPECT_EQ(line.option("subject-out"), "--subject-out");
  EXPECT_EQ(line.advice(Remedy::kNone), "");
  EXPECT_EQ(line.advice(Remedy::kHeight), ", e.g. --height 1.75");
  EXPECT_EQ(line.advice(Remedy::kFrames), " (--frames A:B)");
  EXPECT_EQ(line.advice(Remedy::kIgnoreResiduals), " (--ignore-residuals)");
  EXPECT_EQ(line.advice(Remedy::kUnit), " (another by --unit UNIT)");
  EXPECT_THAT(line.advice(Remedy::kMarkerSet), HasSubstr("the command learn-markers"));
  const Wording python = WordingOf(Medium::kPython);
  EXPECT_EQ(python.option("subject-file"), "subject");
  EXPECT_EQ(python.option("subject"), "prefix");
  EXPECT_EQ(python.option("low-pass"), "low_pass");
  EXPECT_EQ(python.advice(Remedy::kHeight), ", e.g. height=1.75");
  EXPECT_EQ(python.advice(Remedy::kFrames), " (frames=(A, B))");
  EXPECT_EQ(python.advice(Remedy::kIgnoreResiduals), " (ignore_residuals=True)");
  EXPECT_EQ(python.advice(Remedy::kMarkerSet),
            " (marker_set=\"FILE\"); points without names get them by label()");
}

}  // namespace
}  // namespace mmm_converter
