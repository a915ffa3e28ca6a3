// SPDX-License-Identifier: MIT
// --subject-file, with subjects that are written here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "common/convert/marker_mapping.h"
#include "common/io/mmm/mmm_model.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/io/mmm/subject_file.h"
#include "common/io/recording/recording.h"
#include "common/model/forward_kinematics.h"
#include "common/model/model_scaling.h"
#include "tests/cli/program.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using testing::Handstand;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ReadText;
using testing::RunProgram;
using testing::SourcePath;
using testing::TestFolder;
using testing::WithTestConverter;
using testing::WriteText;
using Json = nlohmann::json;

std::string Truth() { return SourcePath("examples/handstand_true.xml"); }

std::string WriteSubject(const Subject& subject, const std::string& name) {
  std::string file = TestFolder() + "/" + name;
  WriteText(file, FormatSubject(subject, "a test"));
  return file;
}

Subject Nobody() {
  Subject subject;
  subject.name = "nobody";
  subject.model = "MMM";
  subject.height = 1.8;
  subject.mass = 75;
  return subject;
}

/// Whose markers sit where they sit on average in the sample, at its true postures.
Subject Gymnast() {
  const KinematicModel model =
      ScaleWinter(ReadMmmModel(SourcePath("xml_config/models/mmm.xml")), {1.8, 75, std::nullopt});
  const MarkerSequence markers = ReadRecording(Handstand(), {}).markers;
  const PoseTrajectory truth = ReadMmmMotionFile(Truth()).motions.at(0).trajectory;
  Subject subject = Nobody();
  subject.name = "gymnast";
  for (int label = 0; label < markers.num_labels(); ++label) {
    MarkerOffset offset;
    offset.marker = "MARKER_" + markers.labels()[label];
    const ModelMarker& marker = model.markers().at(model.FindMarker(offset.marker));
    for (int k = 0; k < markers.num_frames(); k += 10) {
      Posture posture = ZeroPosture(model);
      posture.position = truth.postures[k].position;
      posture.orientation = truth.postures[k].orientation;
      for (std::size_t i = 0; i < truth.joint_names.size(); ++i) {
        posture.joint_angles[model.FindJoint(truth.joint_names[i])] =
            truth.postures[k].joint_angles[static_cast<Eigen::Index>(i)];
      }
      const Eigen::Isometry3d X_WS = SegmentPoses(model, posture)[marker.segment];
      offset.offset += X_WS.inverse() * Eigen::Vector3d(markers.frame(k).col(label)) - marker.p_SM;
      ++offset.frames;
    }
    offset.offset /= offset.frames;
    subject.offsets.push_back(offset);
  }
  return subject;
}

std::vector<std::string> Convert(std::vector<std::string> options) {
  options.insert(options.begin(),
                 {"convert", Handstand(), "--frames", ":40", "-o", TestFolder() + "/o.xml"});
  return options;
}

MmmMotion Converted() { return ReadMmmMotionFile(TestFolder() + "/o.xml").motions.at(0); }

double LargestDifference(const PoseTrajectory& a, const PoseTrajectory& b) {
  double largest = 0;
  for (int k = 0; k < a.num_frames(); ++k) {
    largest = std::max(
        largest, (a.postures[k].joint_angles - b.postures[k].joint_angles).cwiseAbs().maxCoeff());
    largest = std::max(largest, (a.postures[k].position - b.postures[k].position).norm());
  }
  return largest;
}

TEST(SubjectFileOption, SaysHeightAndMass) {
  const std::string file = WriteSubject(Nobody(), "nobody.xml");
  const std::string json_file = TestFolder() + "/o.json";
  const auto run =
      RunProgram(WithTestConverter(Convert({"--subject-file", file, "--summary", json_file})));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out,
              AllOf(HasSubstr("1.8 m (" + file + "), 75 kg"),
                    HasSubstr("subject    \"nobody\": 0 segments, 0 markers, from " + file),
                    HasSubstr("--model-out writes the subject's model")));
  EXPECT_EQ(Converted().size.height, 1.8);
  EXPECT_EQ(Converted().size.mass, 75);
  const Json json = Json::parse(ReadText(json_file));
  EXPECT_EQ(json["person"]["height_source"], file);
  EXPECT_EQ(json["subject"]["name"], "nobody");
  EXPECT_EQ(json["subject"]["file"], file);
  EXPECT_TRUE(json["subject"]["calibration"].is_null());
}

TEST(SubjectFileOption, NobodyInParticularChangesNothing) {
  EXPECT_EQ(RunProgram(Convert({"--height", "1.8", "--mass", "75"})).exit_code, 0);
  const MmmMotion plain = Converted();
  const auto run = RunProgram(Convert({"--subject-file", WriteSubject(Nobody(), "n.xml")}));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(LargestDifference(Converted().trajectory, plain.trajectory), 0);
}

TEST(SubjectFileOption, TheMotionSaysWhoseAnglesItHas) {
  const std::string file = WriteSubject(Nobody(), "nobody.xml");
  for (const char* format : {"2.0", "1.0"}) {
    const auto run =
        RunProgram(WithTestConverter(Convert({"--subject-file", file, "--format", format})));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(ReadText(TestFolder() + "/o.xml"),
                HasSubstr("<!-- Root poses and joint angles are those of the subject nobody "
                          "(nobody.xml), whose segment lengths"));
    EXPECT_EQ(Converted().size.height, 1.8);  // still the processor's
  }
  EXPECT_EQ(RunProgram(WithTestConverter(Convert({"--height", "1.8"}))).exit_code, 0);
  EXPECT_THAT(ReadText(TestFolder() + "/o.xml"), Not(HasSubstr("<!--")));
}

TEST(SubjectFileOption, InPlaceItIsSaidOnce) {
  const std::string file = WriteSubject(Nobody(), "nobody.xml");
  ASSERT_EQ(RunProgram(WithTestConverter(Convert({"--subject-file", file}))).exit_code, 0);
  const std::string motion = TestFolder() + "/o.xml";
  const auto run =
      RunProgram(WithTestConverter({"convert", motion, "--subject-file", file, "-o", motion}));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const std::string text = ReadText(motion);
  EXPECT_EQ(text.find("<!--"), text.rfind("<!--"));
}

TEST(SubjectFileOption, BringsTheModelToTheMarkers) {
  const std::string file = WriteSubject(Gymnast(), "gymnast.xml");
  const auto mean = [&](const std::vector<std::string>& person) {
    const std::string json_file = TestFolder() + "/o.json";
    std::vector<std::string> call = {"convert",   Handstand(), "-o", TestFolder() + "/o.xml",
                                     "--summary", json_file};
    call.insert(call.end(), person.begin(), person.end());
    const auto run = RunProgram(call);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return Json::parse(ReadText(json_file))["distance_mm"]["mean"].get<double>();
  };
  EXPECT_GT(mean({"--height", "1.8"}), 30);
  // What is left is the sample's soft tissue: 4 mm rms per axis are 6.4 mm on average.
  EXPECT_LT(mean({"--subject-file", file}), 6.4);
}

TEST(SubjectFileOption, TheWrittenModelIsThePersonForEveryProgram) {
  const std::string model = TestFolder() + "/gymnast_model.xml";
  Subject gymnast = Gymnast();
  gymnast.scales = {{"LKsegment_joint", 1.03, 0, 0}, {"BTSegment_joint", 0.97, 0, 0}};
  auto run = RunProgram(
      Convert({"--subject-file", WriteSubject(gymnast, "gymnast.xml"), "--model-out", model}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("The subject's model: " + model));
  EXPECT_THAT(ReadText(TestFolder() + "/o.xml"), HasSubstr("model: gymnast_model.xml"));
  const MmmMotion with_subject = Converted();
  run = RunProgram(Convert({"--model", model, "--height", "1.8", "--mass", "75"}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  // The model is written with 10 digits, the motion with 8 decimals.
  EXPECT_LT(LargestDifference(Converted().trajectory, with_subject.trajectory), 1e-5);
}

TEST(SubjectFileOption, AnotherHeightIsAContradiction) {
  const std::string file = WriteSubject(Nobody(), "nobody.xml");
  const std::string person = TestFolder() + "/person.xml";
  WriteText(person,
            "<ModelProcessorConfig type='Winter'><Height>1.7</Height></ModelProcessorConfig>");
  for (const std::vector<std::string>& option :
       {std::vector<std::string>{"--height", "1.7"}, {"--person", person}}) {
    const auto run = RunProgram(Convert({"--subject-file", file, option[0], option[1]}));
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.err, AllOf(HasSubstr(file + ": is calibrated for height 1.8 m, not for 1.7 m"),
                               HasSubstr("leave the height out")));
    EXPECT_FALSE(std::filesystem::exists(TestFolder() + "/o.xml"));
  }
  const auto run = RunProgram(Convert({"--subject-file", file, "--hand-length", "0.19"}));
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("is calibrated for hand length by the height, not for 0.19 m"));
  EXPECT_EQ(RunProgram(Convert({"--subject-file", file, "--height", "1.80"})).exit_code, 0);
}

TEST(SubjectFileOption, AnotherMassIsTakenWithAWarning) {
  const std::string file = WriteSubject(Nobody(), "nobody.xml");
  const auto run = RunProgram(Convert({"--subject-file", file, "--mass", "81"}));
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.err, HasSubstr("has a mass of 75 kg; 81 kg (given) is taken"));
  EXPECT_EQ(Converted().size.mass, 81);
}

TEST(SubjectFileOption, CommandLineComesBeforeTheConfiguration) {
  Subject other = Nobody();
  other.mass = 90;
  WriteSubject(Nobody(), "nobody.xml");
  const std::string config = TestFolder() + "/config.xml";
  WriteText(config,
            "<ConverterConfig type='TestConverter'><Model name='Winter'><Subject "
            "file='nobody.xml'/></Model></ConverterConfig>");
  EXPECT_EQ(RunProgram(WithTestConverter(Convert({"-c", config}))).exit_code, 0);
  EXPECT_EQ(Converted().size.mass, 75);
  EXPECT_EQ(RunProgram(WithTestConverter(Convert(
                           {"-c", config, "--subject-file", WriteSubject(other, "other.xml")})))
                .exit_code,
            0);
  EXPECT_EQ(Converted().size.mass, 90);
}

TEST(SubjectFileOption, ComparisonsAndReportsTakeIt) {
  const std::string file = WriteSubject(Gymnast(), "gymnast.xml");
  const std::string json_file = TestFolder() + "/figures.json";
  const auto mean = [&] {
    return Json::parse(ReadText(json_file))["rows"][0]["distance_mm"]["mean"].get<double>();
  };
  auto run = RunProgram({"compare", Handstand(), "--frames", ":40", "-c", "jacobian_least_squares",
                         "--subject-file", file, "--json", json_file});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_LT(mean(), 6.4);  // as above
  const std::string page = TestFolder() + "/page.html";
  run = RunProgram(
      {"report", Handstand(), Truth(), "--subject-file", file, "-o", page, "--json", json_file});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_LT(mean(), 6.5);  // at the true postures: 4 sqrt(8/pi) mm
  EXPECT_THAT(ReadText(page), HasSubstr("\"gymnast\""));
}

TEST(SubjectFileOption, BadSubjectsAreRefused) {
  const std::string file = TestFolder() + "/bad.xml";
  WriteText(file,
            "<Subject model='MMM' height_m='1.8' mass_kg='75'>\n<Segments>\n"
            "<Segment name='LKsegmnt_joint' scale='1'/>\n<Segment name='LKsegment_joint' "
            "scale='nan'/>\n</Segments></Subject>");
  auto run = RunProgram(Convert({"--subject-file", file}));
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, AllOf(HasSubstr(file + ":3: <Segment>: the model MMM has no "
                                              "\"LKsegmnt_joint\" (did you mean LKsegment_joint?)"),
                             HasSubstr(file + ":4: <Segment>: scale=\"nan\" is not allowed")));
  run = RunProgram(Convert({"--subject-file", TestFolder() + "/nothing.xml"}));
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("nothing.xml"));
  Subject other = Nobody();
  other.model = "robot";
  run = RunProgram(Convert({"--subject-file", WriteSubject(other, "other.xml")}));
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("is a subject of the model \"robot\", this model is \"MMM\""));
  EXPECT_FALSE(std::filesystem::exists(TestFolder() + "/o.xml"));
}

TEST(SubjectFileOption, UnscaledModelsHaveNoSubject) {
  const std::string config = TestFolder() + "/config.xml";
  WriteText(config, "<ConverterConfig type='S2KFConverter'><Model name='None'/></ConverterConfig>");
  const auto run =
      RunProgram(Convert({"-c", config, "--subject-file", WriteSubject(Nobody(), "n.xml")}));
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(
      run.err,
      AllOf(HasSubstr("the model is not scaled (it is a URDF or one of OpenSim, or " + config),
            HasSubstr("<Model name=\"None\">), but the subject")));
}

TEST(ModelOut, NeedsASubjectAndOverwritesNothingThatIsRead) {
  const std::string model = TestFolder() + "/model.xml";
  auto run = RunProgram(Convert({"--height", "1.8", "--model-out", model}));
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("no subject is known whose model that would be"));
  std::filesystem::copy_file(SourcePath("xml_config/models/mmm.xml"), model);
  const std::string file = WriteSubject(Nobody(), "nobody.xml");
  run = RunProgram(Convert({"--subject-file", file, "--model", model, "--model-out", model}));
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("is read, and would be lost"));
  EXPECT_EQ(ReadText(model), ReadText(SourcePath("xml_config/models/mmm.xml")));
  EXPECT_FALSE(std::filesystem::exists(TestFolder() + "/o.xml"));
}

}  // namespace
}  // namespace mmm_converter
