// SPDX-License-Identifier: MIT
// The front door, as a program outside uses it.
#include "common/mmm_converter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>

#include "common/io/bytes/file_content.h"
#include "common/pipeline/conversion.h"
#include "common/support/advice.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Key;
using ::testing::Not;

constexpr int kPiece = 30;
const char* const kSample = MMM_CONVERTER_SOURCE_DIR "/examples/handstand.c3d";

mmm::Options SampleOptions() { return {{"height", 1.8}, {"frames", "0:30"}}; }

std::string Complaint(const std::function<void()>& work) {
  try {
    work();
  } catch (const mmm::Error& error) {
    return error.what();
  }
  return "no error";
}

class FrontDoorTest : public ::testing::Test {
 protected:
  // Other suites of the program have the library's plain words.
  static void TearDownTestSuite() {
    SetWording({[](const std::string& name) { return name; }, [](Remedy) { return ""; }});
  }
  const std::string folder_ = testing::TestFolder();
};

TEST_F(FrontDoorTest, ConvertsAsThePipelineDoes) {
  ConversionRequest request;
  request.input.file = kSample;
  request.input.end_frame = kPiece;
  request.input.person.size.height = 1.8;
  request.output = folder_ + "/expected.xml";
  ConversionReport expected = RunConversion(request, {}, {});
  WriteConversion(request, &expected);

  int last = 0;
  mmm::Conversion walk = mmm::Convert(kSample, SampleOptions(), [&](int done, int all) {
    EXPECT_EQ(all, kPiece);
    last = done;
    return true;
  });
  EXPECT_EQ(last, kPiece);
  EXPECT_EQ(walk.motion().num_frames(), kPiece);
  EXPECT_EQ(walk.motion().postures.back().joint_angles,
            expected.result.trajectory.postures.back().joint_angles);
  EXPECT_EQ(walk.motion().standard_deviations.rows(), 6 + 44);
  EXPECT_EQ(walk.distances(), expected.result.residuals);
  EXPECT_EQ(walk.mean_distance(), expected.figures.distance.mean);
  EXPECT_EQ(walk.markers().size(), 53);
  EXPECT_EQ(walk.markers()[0], LabelOf(expected.plan, 0));
  EXPECT_EQ(walk.marker_set(), "KIT");
  EXPECT_EQ(walk.height(), 1.8);
  EXPECT_EQ(walk.verdict().reasons, expected.verdict.reasons);
  EXPECT_EQ(walk.warnings(), expected.warnings.texts());

  walk.Save(folder_ + "/motion.xml");
  EXPECT_EQ(ReadFileContent(folder_ + "/motion.xml"), ReadFileContent(request.output));
}

TEST_F(FrontDoorTest, HasAnglesThatCliniciansKnow) {
  const mmm::AnatomicalAngles angles = mmm::Convert(kSample, SampleOptions()).anatomical_angles();
  EXPECT_EQ(angles.num_frames(), kPiece);
  EXPECT_EQ(angles.deviations.rows(), angles.values.rows());
  EXPECT_TRUE(std::any_of(angles.angles.begin(), angles.angles.end(), [](const auto& angle) {
    return std::string(angle.joint) == "knee" && std::string(angle.side) == "left";
  }));
}

TEST_F(FrontDoorTest, WritesExportsAndReplacesNothingThatItRead) {
  const std::string recording = folder_ + "/walk.c3d";
  std::filesystem::copy_file(kSample, recording);
  mmm::Conversion walk = mmm::Convert(recording, SampleOptions());
  walk.Export("csv", folder_ + "/walk.csv");
  EXPECT_THAT(ReadFileContent(folder_ + "/walk.csv"), HasSubstr("BLNx_joint"));
  EXPECT_THAT(Complaint([&] { walk.Save(recording); }), HasSubstr("is the recording itself"));
  EXPECT_THAT(Complaint([&] { walk.Export("csv", recording); }), HasSubstr("walk.c3d"));
  EXPECT_EQ(ReadFileContent(recording), ReadFileContent(kSample));
  EXPECT_THAT(Complaint([&] { walk.Export("doc", folder_ + "/walk.doc"); }),
              AllOf(HasSubstr("there is no export \"doc\""), HasSubstr("csv")));
  EXPECT_FALSE(std::filesystem::exists(folder_ + "/walk.doc"));
  EXPECT_THAT(mmm::DescribeExports(), Contains(Key("csv")));
}

TEST_F(FrontDoorTest, RefusesOptionsThatThereAreNot) {
  EXPECT_THAT(Complaint([] {
                mmm::Convert(kSample, {{"hight", 1.8}});
              }),
              AllOf(HasSubstr("there is no option \"hight\" of Convert"), HasSubstr("height")));
  EXPECT_THAT(Complaint([] {
                mmm::Convert(kSample, {{"height", 180}});
              }),
              HasSubstr("height: \"180\" is not allowed"));
  EXPECT_THAT(Complaint([] {
                mmm::Convert(kSample, {{"height", std::vector<std::string>{}}});
              }),
              HasSubstr("it is one value"));
  EXPECT_THAT(Complaint([] {
                mmm::Read(kSample, {{"height", 1.8}});
              }),
              HasSubstr("there is no option \"height\" of Read"));
  EXPECT_THAT(Complaint([] {
                mmm::Convert(kSample, {{"self_calibrate", true}, {"subject", "anna.xml"}});
              }),
              HasSubstr("self_calibrate estimates the person"));
  const auto described = mmm::DescribeOptions(mmm::Task::kConvert);
  EXPECT_THAT(described, Contains(Key("marker_set")));
  EXPECT_THAT(described, Not(Contains(Key("condition"))));  // of a page, which is not written here
  EXPECT_THAT(mmm::DescribeOptions(mmm::Task::kTrack), Not(Contains(Key("unit"))));
}

TEST_F(FrontDoorTest, TakesRecordingsThatWereReadAndMarkersOfTheProgram) {
  const mmm::Recording read = mmm::Read(kSample);
  EXPECT_EQ(read.format(), "C3D");
  EXPECT_EQ(read.markers().num_labels(), 53);
  const mmm::Recording made(read.markers().Slice(0, kPiece), "handstand");
  EXPECT_EQ(made.file(), "handstand");
  const auto last_of = [](const mmm::Recording& recording) -> Eigen::VectorXd {
    return mmm::Convert(recording, SampleOptions()).motion().postures.back().joint_angles;
  };
  const Eigen::VectorXd expected =
      mmm::Convert(kSample, SampleOptions()).motion().postures.back().joint_angles;
  EXPECT_EQ(last_of(read), expected);
  EXPECT_EQ(last_of(made), expected);
  EXPECT_THAT(Complaint([&] {
                mmm::Convert(read, {{"unit", "cm"}});
              }),
              HasSubstr("unit: the recording was read without it; give it to Read"));
  EXPECT_NO_THROW(mmm::Convert(mmm::Read(kSample, {{"unit", "mm"}}),
                               {{"unit", "mm"}, {"height", 1.8}, {"frames", "0:30"}}));
}

TEST_F(FrontDoorTest, RefusesMarkersThatAreNoRecording) {
  const auto failure = [](MarkerSequence markers) {
    return Complaint([&] { mmm::Recording(std::move(markers), "made"); });
  };
  EXPECT_THAT(failure(MarkerSequence({}, 3, 100, 0)), HasSubstr("there are none"));
  EXPECT_THAT(failure(MarkerSequence({"a", "a"}, 3, 100, 0)), HasSubstr("a is there twice"));
  EXPECT_THAT(failure(MarkerSequence({"a"}, 3, 0.1, 0)), HasSubstr("frames a second"));
  MarkerSequence infinite({"a"}, 3, 100, 0);
  infinite.frame(2)(1, 0) = -std::numeric_limits<double>::infinity();
  EXPECT_THAT(failure(infinite), HasSubstr("infinite"));
}

TEST_F(FrontDoorTest, EndsWhereTheCallerAsksForIt) {
  EXPECT_THROW(mmm::Convert(kSample, SampleOptions(), [](int, int) { return false; }), mmm::Error);
}

TEST_F(FrontDoorTest, TracksFrameByFrameWhatConvertGives) {
  const MarkerSequence markers = mmm::Read(kSample).markers().Slice(0, kPiece);
  const mmm::Conversion whole = mmm::Convert(mmm::Recording(markers, "whole"), {{"height", 1.8}});
  mmm::Tracker tracker(markers.labels(), markers.rate(), {{"height", 1.8}});
  EXPECT_EQ(tracker.joint_names(), whole.motion().joint_names);
  EXPECT_EQ(tracker.markers(), whole.markers());
  EXPECT_THAT(tracker.warnings(), IsEmpty());
  EXPECT_EQ(tracker.Track(Eigen::Matrix3Xd::Constant(3, 53, std::nan("")), -1), nullptr);
  for (int k = 0; k < kPiece; ++k) {
    const mmm::TrackedFrame* frame = tracker.Track(markers.frame(k), markers.time(k));
    ASSERT_NE(frame, nullptr) << k;
    const Posture& expected = whole.motion().postures[static_cast<std::size_t>(k)];
    EXPECT_EQ(frame->posture.position, expected.position) << k;
    EXPECT_EQ(frame->posture.joint_angles, expected.joint_angles) << k;
    EXPECT_EQ(frame->standard_deviations, whole.motion().standard_deviations.col(k)) << k;
    EXPECT_EQ(frame->distances, whole.distances().col(k)) << k;
    EXPECT_EQ(frame->markers_seen, 53);
    tracker.Prepare();
  }
  EXPECT_THAT(Complaint([&] { tracker.Track(Eigen::Matrix3Xd::Zero(3, 52), 1); }),
              HasSubstr("the frame has 52 points; its labels are 53"));
}

TEST_F(FrontDoorTest, TracksOnlyWhomItKnows) {
  const std::vector<std::string> labels = mmm::Read(kSample).markers().labels();
  EXPECT_THAT(Complaint([&] { mmm::Tracker(labels, 100, {}); }), HasSubstr("height"));
  EXPECT_THAT(Complaint([&] {
                mmm::Tracker({"a", "b", "c"}, 100, {{"height", 1.8}});
              }),
              HasSubstr("option \"marker_set\""));
  EXPECT_THAT(Complaint([&] {
                mmm::Tracker({"LFHD", "LFHD"}, 100, {{"height", 1.8}});
              }),
              HasSubstr("LFHD is there twice"));
  EXPECT_THAT(Complaint([&] {
                mmm::Tracker(labels, 0, {{"height", 1.8}});
              }),
              HasSubstr("frames a second"));
}

TEST_F(FrontDoorTest, CalibratesAPerson) {
  const mmm::Recording recording(mmm::Read(kSample).markers().Slice(0, 400), "movement");
  const mmm::Person anna = mmm::Calibrate({recording}, {{"height", 1.8}, {"name", "anna"}});
  EXPECT_EQ(anna.subject().name, "anna");
  EXPECT_EQ(anna.subject().height, 1.8);
  EXPECT_LT(anna.mean_distance(), anna.mean_distance_before());
  const std::string file = folder_ + "/anna.xml";
  anna.Save(file);
  anna.SaveModel(folder_ + "/anna_model.xml");
  EXPECT_THAT(ReadFileContent(folder_ + "/anna_model.xml"), HasSubstr("<Robot"));
  const auto distance = [&](const mmm::Options& options) {
    return mmm::Convert(mmm::Recording(recording.markers().Slice(0, kPiece), "walk"), options)
        .mean_distance();
  };
  EXPECT_LT(distance({{"subject", file}}), 0.5 * distance({{"height", 1.8}}));
  EXPECT_THAT(Complaint([] { mmm::Calibrate({}); }), HasSubstr("which recordings"));
}

}  // namespace
}  // namespace mmm_converter
