// SPDX-License-Identifier: MIT
// A conversion by the library alone, as any program can ask for it.
#include "common/pipeline/conversion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "common/io/mmm/mmm_motion.h"
#include "common/support/error.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using ::testing::HasSubstr;

constexpr int kFrames = 30;

// The beginning of the sample.
ConversionRequest SampleRequest() {
  ConversionRequest request;
  request.input.file = MMM_CONVERTER_SOURCE_DIR "/examples/handstand.c3d";
  request.input.end_frame = kFrames;
  request.input.person.size.height = 1.8;
  request.output = testing::TestFolder() + "/motion.xml";
  return request;
}

std::string FailureOf(const ConversionRequest& request) {
  try {
    RunConversion(request, {}, {});
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Conversion, PlansBeforeAnythingIsTracked) {
  const ConversionPlan plan = PlanConversion(SampleRequest(), {});
  EXPECT_EQ(plan.setup.assignments().size(), 53);
  EXPECT_EQ(plan.setup.marker_set, "KIT");
  EXPECT_EQ(plan.person.height.value, 1.8);
  EXPECT_EQ(plan.person.mass.source, "assumed");
  EXPECT_EQ(plan.converter.config.type, "S2KFConverter");
  EXPECT_EQ(plan.output_format, "2.0");
  EXPECT_FALSE(plan.calibration);
  EXPECT_EQ(LabelOf(plan, 0),
            plan.input.recording.markers.labels()[plan.setup.assignments()[0].label]);
}

TEST(Conversion, CarriesOutAPlanAndWritesTheMotion) {
  const ConversionRequest request = SampleRequest();
  int last = 0;
  ConversionReport report = RunConversion(request, {}, [&](int done, int all) {
    EXPECT_EQ(all, kFrames);
    last = done;
    return true;
  });
  EXPECT_EQ(last, kFrames);
  EXPECT_EQ(report.result.trajectory.num_frames(), kFrames);
  EXPECT_LT(report.figures.distance.mean, 0.05);
  EXPECT_FALSE(std::filesystem::exists(request.output));
  WriteConversion(request, &report);
  const MmmMotionFile written = ReadMmmMotionFile(request.output);
  ASSERT_EQ(written.motions.size(), 1);
  EXPECT_EQ(written.motions[0].trajectory.num_frames(), kFrames);
  EXPECT_EQ(written.motions[0].size.height, 1.8);
}

TEST(Conversion, EndsWhereTheCallerAsksForIt) {
  EXPECT_THROW(RunConversion(SampleRequest(), {}, [](int, int) { return false; }), Error);
}

TEST(Conversion, LabelsAStepAhead) {
  ConversionRequest request = SampleRequest();
  EXPECT_EQ(LabelFirst(request, {}, {}).named.value, nullptr);  // nothing is asked for
  request.label = true;
  EXPECT_THAT(FailureOf(request), HasSubstr("to be named first"));
}

TEST(Conversion, BuildsNoModelWhereThatIsNotWanted) {
  ConversionRequest request = SampleRequest();
  request.input.person = {};
  request.is_object = true;
  request.builds_models = false;
  EXPECT_THAT(FailureOf(request), HasSubstr("no folder for one that is built"));
}

TEST(Conversion, RefusesAnOutputThatIsTheRecording) {
  ConversionRequest request = SampleRequest();
  request.output = request.input.file;
  EXPECT_THAT(FailureOf(request), HasSubstr("is the recording itself"));
}

}  // namespace
}  // namespace mmm_converter
