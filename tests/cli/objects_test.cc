// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "common/io/mmm/mmm_model.h"
#include "common/io/mmm/mmm_motion.h"
#include "tests/cli/moving_object.h"
#include "tests/cli/pose_deviation.h"
#include "tests/cli/program.h"
#include "tests/support/shared_data.h"
#include "tests/support/test_plugins.h"

namespace mmm_converter {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using ::testing::AllOf;
using testing::Deviation;
using testing::DeviationOf;
using testing::FindMotion;
using ::testing::HasSubstr;
using testing::kBox;
using testing::MovingPose;
using ::testing::Not;
using testing::PosesOf;
using testing::ReadText;
using testing::RunProgram;
using testing::TestFolder;
using testing::WriteText;

struct ObjectOptions {
  int frames = 60;
  std::string model_path = "nowhere/box.xml";
  bool has_gaps = false;  // one marker after the other is hidden, from frame 10 on
  int first_frame = 0;    // earlier ones show nothing
  int jump_at = 1 << 20;  // from there on it stands turned, elsewhere
};

Isometry3d PoseAt(int k, const ObjectOptions& options) {
  if (k < options.jump_at) return MovingPose(k);
  return Eigen::Translation3d(0.5, 0, 0) * MovingPose(k) *
         Eigen::AngleAxisd(2, Vector3d(1, 1, 1).normalized());
}

// A <Motion> with the markers NAME_0, NAME_1, ...
std::string ObjectMotion(const std::string& name, const Matrix3Xd& body,
                         const ObjectOptions& options = {}) {
  std::string xml = fmt::format(
      "  <Motion name=\"{}\" type=\"object\"><Model path=\"{}\"/><Sensors>\n"
      "    <Sensor type=\"MoCapMarker\" version=\"1.0\"><Configuration/><Data>\n",
      name, options.model_path);
  for (int k = 0; k < options.frames; ++k) {
    xml += fmt::format("<Measurement timestep=\"{:.2f}\">", 0.01 * k);
    const Matrix3Xd p = 1e3 * (PoseAt(k, options) * body);
    for (int i = 0; i < body.cols() && k >= options.first_frame; ++i) {
      if (options.has_gaps && k >= 10 && i == k / 10 % body.cols()) continue;
      xml += fmt::format("<MarkerPosition name=\"{}_{}\">{:.4f} {:.4f} {:.4f}</MarkerPosition>",
                         name, i, p(0, i), p(1, i), p(2, i));
    }
    xml += "</Measurement>\n";
  }
  return xml + "    </Data></Sensor></Sensors></Motion>\n";
}

std::string WriteRecording(const std::string& motions) {
  std::string file = TestFolder() + "/recording.xml";
  WriteText(file, "<MMM version=\"2.0\">\n" + motions + "</MMM>\n");
  return file;
}

std::vector<Isometry3d> TruePoses(int begin, int end) {
  std::vector<Isometry3d> poses;
  for (int k = begin; k < end; ++k) poses.push_back(MovingPose(k));
  return poses;
}

// The filter assumes noise: what it lags behind exact markers, measured as at most 0.05 mm and
// degrees.
constexpr double kLagMillimetres = 0.1;
constexpr double kLagDegrees = 0.1;

TEST(Objects, AllMotionsOfAFileAreConvertedInOneRun) {
  ObjectOptions gaps;
  gaps.has_gaps = true;
  const std::string input =
      WriteRecording(ObjectMotion("box", kBox) + ObjectMotion("bag", kBox, gaps) +
                     ObjectMotion("tag", kBox.leftCols(3)) +
                     "<Motion name=\"shelf\" type=\"object\"><Sensors/></Motion>\n");
  const std::string output = TestFolder() + "/out.xml";
  const std::string summary = TestFolder() + "/out.json";
  const auto run = RunProgram({"convert", input, "--motion", "all", "-o", output, "--summary",
                               summary, "--report", TestFolder() + "/out.html"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("box"), HasSubstr("built from 60 frames"),
                             HasSubstr("shelf  has no markers; left as it is"),
                             HasSubstr("written to " + output)));
  const MmmMotionFile file = ReadMmmMotionFile(output);
  for (const char* name : {"box", "bag", "tag"}) {
    const MmmMotion& motion = FindMotion(file, name);
    EXPECT_EQ(motion.model_path, fmt::format("out_objects/{}.xml", name));
    EXPECT_FALSE(motion.size.height.has_value());
    EXPECT_TRUE(std::filesystem::exists(TestFolder() + "/" + motion.model_path));
    const Deviation deviation = DeviationOf(PosesOf(motion), TruePoses(0, 60));
    EXPECT_LT(deviation.millimetres, kLagMillimetres) << name;
    EXPECT_LT(deviation.degrees, kLagDegrees) << name;
  }
  const auto json = nlohmann::json::parse(ReadText(summary));
  ASSERT_EQ(json["motions"].size(), 4);
  EXPECT_EQ(json["motions"][0]["name"], "box");
  EXPECT_EQ(json["motions"][0]["summary"]["object"]["model_is_new"], true);
  EXPECT_TRUE(json["motions"][3]["summary"].is_null());
}

TEST(Objects, EveryConverterTracksThem) {
  const std::string input = WriteRecording(ObjectMotion("tag", kBox.leftCols(3)));
  for (const char* config :
       {"s2kf_paper", "s2kf_offline", "ukf", "ekf", "jacobian_least_squares", "jacobian_pull"}) {
    const std::string output = TestFolder() + "/" + config + ".xml";
    const auto run = RunProgram({"convert", input, "--motion", "tag", "-c", config, "-o", output});
    EXPECT_EQ(run.exit_code, 0) << config << run.err;
    EXPECT_THAT(run.out, HasSubstr("0 joints tracked"));
    std::vector<Isometry3d> poses = PosesOf(FindMotion(ReadMmmMotionFile(output), "tag"));
    poses.erase(poses.begin(), poses.begin() + 20);  // the paper's filter starts at zero
    const Deviation deviation = DeviationOf(poses, TruePoses(20, 60));
    // The paper's noise is fixed, and lags more: measured 0.64 mm and 0.74 degrees.
    const bool is_paper = std::string(config) == "s2kf_paper";
    EXPECT_LT(deviation.millimetres, is_paper ? 1 : kLagMillimetres) << config;
    EXPECT_LT(deviation.degrees, is_paper ? 1 : kLagDegrees) << config;
  }
}

TEST(Objects, OneThatStandsElsewhereFromAFrameOnIsFoundThere) {
  ObjectOptions options;
  options.jump_at = 30;
  const std::string input = WriteRecording(ObjectMotion("box", kBox, options));
  for (const char* config : {"s2kf_default", "s2kf_offline"}) {
    const std::string output = TestFolder() + "/" + config + ".xml";
    const auto run = RunProgram({"convert", input, "--motion", "box", "-c", config, "-o", output});
    EXPECT_EQ(run.exit_code, 0) << config << run.err;
    const std::vector<Isometry3d> poses = PosesOf(FindMotion(ReadMmmMotionFile(output), "box"));
    std::vector<Isometry3d> truth;
    truth.reserve(60);
    for (int k = 0; k < 60; ++k) truth.push_back(PoseAt(k, options));
    const Deviation deviation = DeviationOf(poses, truth);
    // Noise that is chosen from the recording takes the jump for motion, and is large.
    const bool is_noise_chosen = std::string(config) == "s2kf_offline";
    EXPECT_LT(deviation.millimetres, is_noise_chosen ? 10 : kLagMillimetres) << config;
    EXPECT_LT(deviation.degrees, is_noise_chosen ? 5 : kLagDegrees) << config;
  }
}

TEST(Objects, AModelOfAnEarlierRecordingIsUsedAgain) {
  const std::string models = TestFolder() + "/models";
  const auto convert = [&](const ObjectOptions& options, const std::string& output) {
    const auto run = RunProgram({"convert", WriteRecording(ObjectMotion("box", kBox, options)),
                                 "--motion", "box", "--object-models", models, "-o", output});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run.out;
  };
  EXPECT_THAT(convert({}, TestFolder() + "/a.xml"), HasSubstr("built from 60 frames"));
  const std::string model = ReadText(models + "/box.xml");
  const auto first = ReadText(TestFolder() + "/a.xml");
  EXPECT_THAT(convert({}, TestFolder() + "/b.xml"), HasSubstr("model in " + models));
  EXPECT_EQ(ReadText(TestFolder() + "/b.xml"), first);  // what is written is what was tracked
  ObjectOptions later;
  later.first_frame = 30;
  convert(later, TestFolder() + "/c.xml");
  EXPECT_EQ(ReadText(models + "/box.xml"), model);
  // The same frame in both recordings: no transform is taken out.
  const std::vector<Isometry3d> a =
      PosesOf(FindMotion(ReadMmmMotionFile(TestFolder() + "/a.xml"), "box"));
  const std::vector<Isometry3d> c =
      PosesOf(FindMotion(ReadMmmMotionFile(TestFolder() + "/c.xml"), "box"));
  EXPECT_LT((a.back().translation() - c.back().translation()).norm(), 1e-3 * kLagMillimetres);
  EXPECT_TRUE(a.back().linear().isApprox(c.back().linear(), kLagDegrees * EIGEN_PI / 180));
}

TEST(Objects, TheModelThatTheMotionNamesIsTakenWhereItIsThere) {
  ObjectOptions options;
  options.model_path = "named.xml";
  WriteText(
      TestFolder() + "/named.xml",
      "<Robot Type=\"box\" RootNode=\"r\"><RobotNode name=\"r\">"
      "<Sensor type=\"position\" name=\"box_0\"><Transform><Translation x=\"0\" y=\"20\" z=\"0\"/>"
      "</Transform></Sensor>"
      "<Sensor type=\"position\" name=\"box_1\"><Transform><Translation x=\"160\" y=\"-10\" "
      "z=\"30\"/>"
      "</Transform></Sensor>"
      "<Sensor type=\"position\" name=\"box_2\"><Transform><Translation x=\"10\" y=\"90\" "
      "z=\"50\"/>"
      "</Transform></Sensor></RobotNode></Robot>\n");
  const std::string input = WriteRecording(ObjectMotion("box", kBox, options));
  const std::string output = TestFolder() + "/out.xml";
  const auto run = RunProgram({"convert", input, "--motion", "all", "-o", output});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("model named by the motion"));
  EXPECT_FALSE(std::filesystem::exists(TestFolder() + "/out_objects"));
  const MmmMotionFile file = ReadMmmMotionFile(output);
  const Posture& last = FindMotion(file, "box").trajectory.postures.back();
  EXPECT_LT((last.position - MovingPose(59).translation()).norm(), 1e-3 * kLagMillimetres);
}

TEST(Objects, RecordingsOfOtherFormatsAreObjectsWhereTheUserSaysSo) {
  const std::string trc = TestFolder() + "/box.trc";
  const auto write = RunProgram({"convert", WriteRecording(ObjectMotion("box", kBox)), "--motion",
                                 "box", "-o", TestFolder() + "/a.xml", "--export-trc", trc});
  ASSERT_EQ(write.exit_code, 0) << write.err;
  const std::string models = TestFolder() + "/models";
  const std::string output = TestFolder() + "/b.xml";
  const std::vector<std::string> call = {
      "convert", trc, "--object", "--object-models", models, "--up", "y", "-o", output};
  const auto run = RunProgram(call);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("built from 60 frames"));
  const MmmMotionFile file = ReadMmmMotionFile(output);
  const MmmMotion& motion = FindMotion(file, "box");
  EXPECT_EQ(motion.model_path, "models/box.xml");
  const Deviation deviation = DeviationOf(PosesOf(motion), TruePoses(0, 60));
  EXPECT_LT(deviation.millimetres, kLagMillimetres);
  EXPECT_LT(deviation.degrees, kLagDegrees);

  const auto person = RunProgram({"convert", trc, "--up", "y", "-o", output});
  EXPECT_EQ(person.exit_code, 1);
  const auto joints = RunProgram({"convert", trc, "--object", "--model",
                                  testing::SourcePath("xml_config/models/mmm.xml"), "-o", output});
  EXPECT_EQ(joints.exit_code, 1);
  EXPECT_THAT(joints.err, HasSubstr("--object: the model has"));
}

TEST(Objects, AMotionThatFailsIsNamedAndTheOthersAreConverted) {
  const Matrix3Xd line = (Matrix3Xd(3, 4) << 0, 0.1, 0.25, 0.3, 0, 0, 0, 0, 0, 0, 0, 0).finished();
  const std::string input =
      WriteRecording(ObjectMotion("rod", line) + ObjectMotion("pair", kBox.leftCols(2)) +
                     ObjectMotion("box", kBox));
  const std::string output = TestFolder() + "/out.xml";
  const auto run = RunProgram({"convert", input, "--motion", "all", "-o", output});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err,
              AllOf(HasSubstr("motion rod: " + input +
                              ": the markers (rod_0, rod_1, rod_2, rod_3) stand on a line"),
                    HasSubstr("motion pair: " + input +
                              ": the pose of a rigid object needs three markers")));
  const MmmMotionFile file = ReadMmmMotionFile(output);
  EXPECT_EQ(FindMotion(file, "box").trajectory.num_frames(), 60);
  EXPECT_EQ(FindMotion(file, "rod").trajectory.num_frames(), 0);

  const std::string hopeless = WriteRecording(ObjectMotion("pair", kBox.leftCols(2)));
  const auto none =
      RunProgram({"convert", hopeless, "--motion", "all", "-o", TestFolder() + "/none.xml"});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_THAT(none.err, HasSubstr("recording.xml: the pose of a rigid"));
  EXPECT_FALSE(std::filesystem::exists(TestFolder() + "/none.xml"));
}

// Exit code 1 with the message, and what was there stays as it was.
void ExpectKept(const std::vector<std::string>& arguments, const std::string& kept,
                const std::string& message) {
  const std::string before = ReadText(kept);
  const auto run = RunProgram(arguments);
  EXPECT_EQ(run.exit_code, 1) << message;
  EXPECT_THAT(run.err, HasSubstr(message));
  EXPECT_EQ(ReadText(kept), before);
}

TEST(Objects, NothingThatIsReadAndNoModelOfOthersIsReplaced) {
  const std::string recording = WriteRecording(ObjectMotion("box", kBox));
  std::filesystem::create_directory(TestFolder() + "/a_objects");
  const std::string as_model = TestFolder() + "/a_objects/box.xml";
  std::filesystem::copy_file(recording, as_model);
  for (const char* motion : {"box", "all"}) {
    ExpectKept({"convert", as_model, "--motion", motion, "-o", TestFolder() + "/a.xml"}, as_model,
               "was not built by this program");
  }
  EXPECT_FALSE(std::filesystem::exists(TestFolder() + "/a.xml"));

  const std::string models = TestFolder() + "/models";
  const std::vector<std::string> call = {
      "convert",         recording, "--motion", "all",
      "--object-models", models,    "-o",       TestFolder() + "/b.xml"};
  ASSERT_EQ(RunProgram(call).exit_code, 0);
  const auto with = [&](const std::string& option, const std::string& file) {
    std::vector<std::string> longer = call;
    longer.insert(longer.end(), {option, file});
    return longer;
  };
  ExpectKept(with("--summary", models + "/box.xml"), models + "/box.xml", "is read");
  ExpectKept(with("--report", recording), recording, "is read");
  ExpectKept({"convert", recording, "--motion", "all", "--object-models", models, "-o",
              models + "/box.xml"},
             models + "/box.xml", "is read");
}

TEST(Objects, MotionsWhoseModelsWouldHaveOneNameAreToldApart) {
  const std::string recording =
      WriteRecording(ObjectMotion("a/b", kBox) + ObjectMotion("a b", kBox));
  for (int run = 0; run < 2; ++run) {  // building the model, and using it again
    const auto both = RunProgram({"convert", recording, "--motion", "all", "--object-models",
                                  TestFolder() + "/models", "-o", TestFolder() + "/out.xml"});
    EXPECT_EQ(both.exit_code, 1);
    EXPECT_THAT(both.err, HasSubstr("motion a b: " + TestFolder() +
                                    "/models/a_b.xml: is the model "
                                    "of a motion before this one"));
  }
}

TEST(Objects, NamedModelsThatDoNotFitAreWarnedOf) {
  ObjectOptions options;
  options.model_path = "named.xml";
  const std::string recording = WriteRecording(ObjectMotion("box", kBox, options));
  for (const char* model :
       {"<Robot", "<Robot Type=\"m\" RootNode=\"r\"><RobotNode name=\"r\"/></Robot>"}) {
    WriteText(TestFolder() + "/named.xml", model);
    const auto run =
        RunProgram({"convert", recording, "--motion", "box", "-o", TestFolder() + "/out.xml"});
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_THAT(run.err, HasSubstr("named.xml, the model that the motion box names, is not used"));
    EXPECT_THAT(run.out, HasSubstr("built from 60 frames"));
  }
}

TEST(Objects, AModelOfAnotherObjectIsToldByItsDistance) {
  const std::string models = TestFolder() + "/models";
  const auto convert = [&](const Matrix3Xd& body) {
    return RunProgram({"convert", WriteRecording(ObjectMotion("box", body)), "--motion", "box",
                       "--object-models", models, "-o", TestFolder() + "/out.xml"});
  };
  EXPECT_THAT(convert(kBox).out, Not(HasSubstr("is it this object's?")));
  EXPECT_THAT(convert(2 * kBox).out, HasSubstr("is it this object's?"));
}

TEST(Objects, APersonIsOneWhereTheUserSaysSo) {
  const auto run = RunProgram({"convert", WriteRecording(ObjectMotion("box", kBox)), "--motion",
                               "box", "--height", "1.8", "-o", TestFolder() + "/out.xml"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("knows three"));
}

TEST(Objects, WhatFitsOneMotionOnlyIsRefused) {
  const std::string input = WriteRecording(ObjectMotion("box", kBox));
  const auto csv =
      RunProgram({"convert", input, "--motion", "all", "--export-csv", TestFolder() + "/o.csv"});
  EXPECT_EQ(csv.exit_code, 2);
  EXPECT_THAT(csv.err, HasSubstr("--export-csv is for one motion"));
  const auto old = RunProgram({"convert", input, "--motion", "all", "--format", "1.0"});
  EXPECT_EQ(old.exit_code, 1);
  EXPECT_THAT(old.err, HasSubstr("MMM 2.0 to MMM 2.0"));
  const auto c3d = RunProgram({"convert", testing::Handstand(), "--motion", "all"});
  EXPECT_EQ(c3d.exit_code, 1);
  EXPECT_THAT(c3d.err, HasSubstr("not an MMM motion file"));
}

}  // namespace
}  // namespace mmm_converter
