// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "common/io/c3d/c3d_writer.h"
#include "common/io/mmm/mmm_model.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/io/mmm/subject_file.h"
#include "common/io/recording/recording.h"
#include "tests/cli/program.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using testing::Handstand;
using ::testing::HasSubstr;
using testing::ReadText;
using testing::RunProgram;
using testing::SharedData;
using ::testing::SizeIs;
using testing::SourcePath;
using testing::TestFolder;
using testing::WriteText;
using Json = nlohmann::json;

Subject ReadResult(const std::string& file) {
  return ReadSubject(file, ReadMmmModel(SourcePath("xml_config/models/mmm.xml")));
}

std::string Kit(const std::string& name) {
  return SharedData("recordings/kit_bimanual_c3d/" + name);
}

bool Exists(const std::string& name) { return std::filesystem::exists(TestFolder() + "/" + name); }

double MeanDistance(std::vector<std::string> call) {
  const std::string json = TestFolder() + "/mean.json";
  call.insert(call.begin(), "convert");
  call.insert(call.end(), {"-o", TestFolder() + "/mean.xml", "--summary", json});
  const auto run = RunProgram(call);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return Json::parse(ReadText(json))["distance_mm"]["mean"];
}

TEST(Calibrate, WritesThePersonTheModelThePageAndTheSummary) {
  const std::string folder = TestFolder();
  const auto run =
      RunProgram({"calibrate", Handstand(), "--height", "1.8", "--mass", "75", "-o",
                  folder + "/s.xml", "--model-out", folder + "/model.xml", "--report",
                  folder + "/page.html", "--summary", folder + "/s.json", "--name", "the gymnast"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("handstand.c3d"), HasSubstr("before"),
                             HasSubstr("segments "), HasSubstr("offsets "), HasSubstr("unknown ")));
  EXPECT_THAT(run.out, HasSubstr(folder + "/s.xml has the person: with it, the best"));
  EXPECT_THAT(run.out, ::testing::EndsWith("verdict    good\n"));
  const Subject subject = ReadResult(folder + "/s.xml");
  EXPECT_EQ(subject.name, "the gymnast");
  EXPECT_EQ(subject.model, "MMM");
  EXPECT_EQ(subject.height, 1.8);
  EXPECT_EQ(subject.mass, 75);
  EXPECT_THAT(subject.offsets, SizeIs(53));
  ASSERT_THAT(subject.sources, SizeIs(1));
  EXPECT_EQ(subject.sources[0].recording, "handstand.c3d");  // no folder: the same bytes anywhere
  const Json json = Json::parse(ReadText(folder + "/s.json"));
  EXPECT_EQ(json["output"], folder + "/s.xml");
  EXPECT_THAT(json["subject"]["markers"], SizeIs(53));
  EXPECT_GT(json["calibration"]["distance_before_mm"], 30);
  // The sample's soft tissue leaves 6.4 mm on average at the truth.
  EXPECT_LT(json["calibration"]["distance_after_mm"], 6.4);
  EXPECT_THAT(ReadText(folder + "/page.html"),
              AllOf(HasSubstr("The person \\\"the gymnast\\\""), HasSubstr("\"subject\"")));
  Warnings warnings;
  ReadMmmModel(folder + "/model.xml", &warnings);
  EXPECT_THAT(warnings.texts(), SizeIs(0));
}

TEST(Calibrate, GoesBesideTheFirstRecording) {
  const std::string recording = TestFolder() + "/jump.c3d";
  std::filesystem::copy_file(Handstand(), recording);
  const auto run = RunProgram({"calibrate", recording, "--height", "1.8", "--frames", ":300"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(ReadResult(TestFolder() + "/jump_subject.xml").name, "jump");
}

TEST(Calibrate, TheSameCallGivesTheSameBytes) {
  const auto calibrate = [](const std::string& name) {
    const auto run = RunProgram({"calibrate", Handstand(), "--height", "1.8", "--frames", ":200",
                                 "-o", TestFolder() + "/" + name});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return ReadText(TestFolder() + "/" + name);
  };
  EXPECT_EQ(calibrate("a.xml"), calibrate("b.xml"));
}

TEST(Calibrate, SelfCalibrationIsCalibratingAndConverting) {
  const std::string anna = TestFolder() + "/anna.xml";
  const std::string motion = TestFolder() + "/o.xml";
  const std::string json_file = TestFolder() + "/o.json";
  auto run = RunProgram({"convert", Handstand(), "--height", "1.8", "--self-calibrate", "-o",
                         motion, "--subject-out", anna, "--model-out", TestFolder() + "/model.xml",
                         "--summary", json_file});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("from this recording: best postures of"),
                             HasSubstr("the angles are the subject's")));
  EXPECT_TRUE(Exists("model.xml"));
  const Json json = Json::parse(ReadText(json_file));
  EXPECT_GT(json["subject"]["calibration"]["distance_before_mm"],
            json["subject"]["calibration"]["distance_after_mm"]);
  EXPECT_LT(json["distance_mm"]["mean"], 6.4);  // as above
  const std::string text = ReadText(motion);
  const std::string own = ReadText(anna);
  run = RunProgram({"calibrate", Handstand(), "--height", "1.8", "-o", anna});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(ReadText(anna), own);
  run = RunProgram({"convert", Handstand(), "--subject-file", anna, "-o", motion, "--model-out",
                    TestFolder() + "/model.xml"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(ReadText(motion), text);
}

// The markers of both were put on once: those of Cut and Stir sit elsewhere.
TEST(CalibrateRealFiles, AnotherRecordingOfTheSessionComesNear) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string subject = TestFolder() + "/1723.xml";
  const auto run = RunProgram(
      {"calibrate", Kit("Peel_1723.c3d"), "--height", "1.68", "--mass", "62", "-o", subject});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(ReadResult(subject).name, "1723");  // the labels' prefix
  const double plain = MeanDistance({Kit("Close_1723.c3d"), "--height", "1.68"});
  EXPECT_GT(plain, 20);
  // How near is a figure of the README; here: the subject does its work on what it has not seen.
  EXPECT_LT(MeanDistance({Kit("Close_1723.c3d"), "--subject-file", subject}), 0.35 * plain);
}

TEST(CalibrateRealFiles, SeveralRecordingsMakeOneSubject) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string json_file = TestFolder() + "/s.json";
  const auto run = RunProgram({"calibrate", Kit("Peel_1723.c3d"), Kit("Close_1723.c3d"), "--height",
                               "1.68", "-o", TestFolder() + "/s.xml", "--summary", json_file});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json json = Json::parse(ReadText(json_file));
  EXPECT_THAT(json["recordings"], SizeIs(2));
  EXPECT_THAT(json["subject"]["sources"], SizeIs(2));
  EXPECT_LT(json["calibration"]["distance_after_mm"].get<double>(),
            0.35 * json["calibration"]["distance_before_mm"].get<double>());
}

TEST(CalibrateRealFiles, SelfCalibratesOtherMarkerSets) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string file = SharedData("recordings/whole_body/cmu_02_05.c3d");
  const double plain = MeanDistance({file, "--frames", ":600"});
  EXPECT_LT(MeanDistance({file, "--frames", ":600", "--self-calibrate"}), 0.5 * plain);
}

TEST(CalibrateRealFiles, MarksEachRecordingsOwnOptions) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string subject = TestFolder() + "/s.xml";
  const auto run = RunProgram({"calibrate", Kit("Cut_1723.c3d"), Kit("Peel_1723.c3d"), "--frames",
                               ":30", "--frames", "20:", "--height", "1.68", "-o", subject});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("of 30 frames taken"));
  const auto wrong =
      RunProgram({"calibrate", Kit("Cut_1723.c3d"), "--frames", ":30", "--frames", "20:"});
  EXPECT_EQ(wrong.exit_code, 2);
}

void ExpectCalibrateRefuses(std::vector<std::string> call, const std::string& message) {
  WriteText(TestFolder() + "/s.xml", "as it was");
  call.insert(call.end(), {"-o", TestFolder() + "/s.xml", "--model-out", TestFolder() + "/m.xml",
                           "--summary", TestFolder() + "/s.json"});
  const auto run = RunProgram(call);
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(run.out, "");
  EXPECT_THAT(run.err, HasSubstr(message));
  EXPECT_TRUE(ReadText(TestFolder() + "/s.xml") == "as it was");
  EXPECT_FALSE(Exists("m.xml"));
  EXPECT_FALSE(Exists("s.json"));
}

TEST(Calibrate, TooShortARecordingSaysSoAndWritesNothing) {
  ExpectCalibrateRefuses({"calibrate", Handstand(), "--height", "1.8", "--frames", ":3"}, "short");
}

TEST(Calibrate, TooStillARecordingSaysSoAndWritesNothing) {
  const MarkerSequence moving = ReadRecording(Handstand(), {}).markers;
  MarkerSequence still(moving.labels(), 300, 100, 0);
  for (int k = 0; k < still.num_frames(); ++k) still.frame(k) = moving.frame(0);
  const std::string file = TestFolder() + "/still.c3d";
  WriteC3d(file, still);
  ExpectCalibrateRefuses({"calibrate", file, "--height", "1.8"}, "still");
  const auto run = RunProgram({"convert", file, "--height", "1.8", "--self-calibrate", "-o",
                               TestFolder() + "/o.xml", "--subject-out", TestFolder() + "/p.xml"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_FALSE(Exists("o.xml"));
  EXPECT_FALSE(Exists("p.xml"));
}

TEST(Calibrate, RecordingsThatCanNotBeReadAreRefused) {
  ExpectCalibrateRefuses(
      {"calibrate", Handstand(), TestFolder() + "/nothing.c3d", "--height", "1.8"},
      "nothing.c3d: no such file");
  WriteText(TestFolder() + "/notes.c3d", "Not a recording.");
  ExpectCalibrateRefuses({"calibrate", TestFolder() + "/notes.c3d", "--height", "1.8"},
                         "notes.c3d");
}

TEST(Calibrate, RecordingsOfTwoPersonsAreRefused) {
  std::vector<std::string> files;
  for (const char* height : {"1.8", "1.6"}) {
    files.push_back(TestFolder() + "/" + height + ".xml");
    ASSERT_EQ(RunProgram({"convert", Handstand(), "--frames", ":60", "--height", height, "-o",
                          files.back()})
                  .exit_code,
              0);
  }
  ExpectCalibrateRefuses({"calibrate", files[0], files[1]},
                         "calibrate with recordings of one person");
}

TEST(Calibrate, NeverOverwritesWhatItReads) {
  const std::string recording = TestFolder() + "/walk.c3d";
  std::filesystem::copy_file(Handstand(), recording);
  const auto run = RunProgram({"calibrate", recording, "--height", "1.8", "-o", recording});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("is read, and would be lost"));
  EXPECT_EQ(ReadText(recording), ReadText(Handstand()));
}

TEST(Calibrate, UnscaledModelsAreRefused) {
  const std::string config = TestFolder() + "/config.xml";
  WriteText(config, "<ConverterConfig type='S2KFConverter'><Model name='None'/></ConverterConfig>");
  ExpectCalibrateRefuses({"calibrate", Handstand(), "-c", config}, "<Model name=\"None\">");
  const auto run = RunProgram(
      {"convert", Handstand(), "-c", config, "--self-calibrate", "-o", TestFolder() + "/o.xml"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("a subject is relative to the scaled one"));
}

}  // namespace
}  // namespace mmm_converter
