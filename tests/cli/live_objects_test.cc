// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "common/io/c3d/c3d_writer.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/io/mmm/mmm_object_model.h"
#include "common/io/recording/recording.h"
#include "tests/cli/moving_object.h"
#include "tests/cli/pose_deviation.h"
#include "tests/cli/program.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3Xd;
using testing::DeviationOf;
using testing::Handstand;
using ::testing::HasSubstr;
using testing::kBox;
using testing::MovingPose;
using ::testing::Not;
using testing::PosesOf;
using testing::ReadText;
using testing::RunProgram;
using testing::TestFolder;

constexpr int kFrames = 100;

const Matrix3Xd kLamp = 1.4 * kBox.rowwise().reverse();

// With the markers M0, M1, ...
std::string WriteModel(const std::string& name, const Matrix3Xd& markers) {
  ModelDescription description;
  description.name = name;
  Segment root;
  root.name = "root_joint";
  description.segments.push_back(root);
  for (int i = 0; i < markers.cols(); ++i) {
    description.markers.push_back({fmt::format("M{}", i), 0, markers.col(i)});
  }
  std::string file = TestFolder() + "/" + name + ".xml";
  testing::WriteText(file, FormatObjectModel(KinematicModel(description), ""));
  return file;
}

// Box and lamp, behind others' markers. Their labels begin with these prefixes.
std::string WriteScene(const std::string& box, const std::string& lamp,
                       const MarkerSequence& others = MarkerSequence({}, kFrames, 100, 0)) {
  std::vector<std::string> labels = others.labels();
  for (const std::string& prefix : {box, lamp}) {
    for (int i = 0; i < 4; ++i) labels.push_back(fmt::format("{}M{}", prefix, i));
  }
  MarkerSequence scene(labels, others.num_frames(), others.rate(), others.first_time());
  for (int k = 0; k < scene.num_frames(); ++k) {
    scene.frame(k) << others.frame(k), MovingPose(k, 0) * kBox, MovingPose(k, 1) * kLamp;
  }
  std::string file = TestFolder() + "/scene.c3d";
  WriteC3d(file, scene, {});
  return file;
}

void ExpectTruePoses(const std::string& file, double phase) {
  std::vector<Isometry3d> truth;
  const MmmMotionFile motion = ReadMmmMotionFile(file);
  for (int k = 0; k < motion.motions.front().trajectory.num_frames(); ++k) {
    truth.push_back(MovingPose(k, phase));
  }
  ASSERT_GE(truth.size(), 100U);
  // The filter assumes noise: it lags behind exact markers, which C3D rounds (objects_test.cc).
  const auto deviation = DeviationOf(PosesOf(motion.motions.front()), truth);
  EXPECT_LT(deviation.millimetres, 0.2);
  EXPECT_LT(deviation.degrees, 0.2);
}

TEST(LiveObjects, SeveralAreTrackedAtOnceWithoutAHeight) {
  const std::string& folder = TestFolder();
  const auto run = RunProgram({"live", "replay:" + WriteScene("Box:", "lamp:") + "@max", "--model",
                               WriteModel("box", kBox), "--and-model", WriteModel("lamp", kLamp),
                               "-o", folder + "/out.xml", "--summary", folder + "/out.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("lamp is seen"));
  ExpectTruePoses(folder + "/out.xml", 0);
  ExpectTruePoses(folder + "/out_lamp.xml", 1);
  EXPECT_EQ(ReadMmmMotionFile(folder + "/out.xml").motions.front().name, "box");
  EXPECT_EQ(ReadMmmMotionFile(folder + "/out_lamp.xml").motions.front().model_path, "lamp.xml");
  const auto summary = nlohmann::json::parse(ReadText(folder + "/out.json"));
  EXPECT_EQ(summary["tracked"], kFrames);
  EXPECT_EQ(summary["objects"][0]["name"], "lamp");
  EXPECT_EQ(summary["objects"][0]["tracked"], kFrames);
  EXPECT_EQ(summary["motions"].size(), 2U);
  EXPECT_FALSE(std::filesystem::exists(folder + "/out_lamp.xml.live"));
}

// The person's motion is the one without them.
TEST(LiveObjects, APersonIsThereToo) {
  const std::string& folder = TestFolder();
  const MarkerSequence person = ReadRecording(Handstand(), {}).markers.Slice(0, kFrames);
  const std::string scene = WriteScene("box:", "lamp:", person);
  const std::string alone = folder + "/handstand.c3d";
  WriteC3d(alone, person, {});
  const auto both = RunProgram({"live", "replay:" + scene + "@max", "--height", "1.8", "--motion",
                                "anna", "--and-model", WriteModel("box", kBox), "--and-model",
                                WriteModel("lamp", kLamp), "-o", folder + "/a.xml"});
  ASSERT_EQ(both.exit_code, 0) << both.err;
  const auto one = RunProgram({"live", "replay:" + alone + "@max", "--height", "1.8", "--motion",
                               "anna", "-o", folder + "/b.xml"});
  ASSERT_EQ(one.exit_code, 0) << one.err;
  const PoseTrajectory a = ReadMmmMotionFile(folder + "/a.xml").motions.front().trajectory;
  const PoseTrajectory b = ReadMmmMotionFile(folder + "/b.xml").motions.front().trajectory;
  ASSERT_EQ(a.num_frames(), b.num_frames());
  for (int k = 0; k < a.num_frames(); ++k) {
    ASSERT_LT(Local(a.postures[k], b.postures[k]).lpNorm<Eigen::Infinity>(), 2e-8);
  }
  ExpectTruePoses(folder + "/a_box.xml", 0);
  ExpectTruePoses(folder + "/a_lamp.xml", 1);
}

// A motion of OpenSim, and MMM's of objects.
TEST(LiveObjects, APersonOfOpenSimIsThereToo) {
  const std::string& folder = TestFolder();
  const std::string examples = testing::SourcePath("examples/opensim/");
  const MarkerSequence person = ReadRecording(examples + "walk.trc", {}).markers;
  const auto run =
      RunProgram({"live", "replay:" + WriteScene("box:", "lamp:", person) + "@max", "--model",
                  examples + "generic.osim", "--and-model", WriteModel("box", kBox), "--and-model",
                  WriteModel("lamp", kLamp), "-o", folder + "/a.mot"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(ReadText(folder + "/a.mot"), HasSubstr("inDegrees"));
  ExpectTruePoses(folder + "/a_box.xml", 0);
  ExpectTruePoses(folder + "/a_lamp.xml", 1);
}

void ExpectObjectsRefused(const std::vector<std::string>& words, int exit_code,
                          const std::string& why) {
  std::vector<std::string> all = {"live"};
  all.insert(all.end(), words.begin(), words.end());
  all.insert(all.end(), {"-o", TestFolder() + "/out.xml"});
  const auto run = RunProgram(all);
  EXPECT_EQ(run.exit_code, exit_code) << run.err;
  EXPECT_THAT(run.err, HasSubstr(why));
  EXPECT_FALSE(std::filesystem::exists(TestFolder() + "/out.xml"));
}

TEST(LiveObjects, WhoseLabelsAreWhoseIsSaid) {
  const std::string box = WriteModel("box", kBox);
  const std::string lamp = WriteModel("lamp", kLamp);
  const std::string scene = "replay:" + WriteScene("a:", "b:") + "@max";
  ExpectObjectsRefused({scene, "--model", box, "--and-model", lamp}, 1, "several prefixes, a or b");
  const std::string one = "replay:" + WriteScene("box:", "other_") + "@max";
  ExpectObjectsRefused({one, "--model", box, "--and-model", lamp}, 1,
                       "is of the object box and of lamp");
  ExpectObjectsRefused({one, "--model", box, "--and-model", box}, 1, "two objects are called box");
  const std::string both = "replay:" + WriteScene("box:", "lamp:") + "@max";
  ExpectObjectsRefused({both, "--model", box, "--and-model", lamp, "--motion", "Lamp"}, 1,
                       "called Lamp, and so is the object lamp");
  const std::string second = WriteModel("box_2", kLamp);
  ExpectObjectsRefused({one, "--height", "1.8", "--and-model", box, "--and-model", second}, 1,
                       "box.xml and box_2.xml would have motions of one name");
  const std::string person = testing::SourcePath("xml_config/models/mmm.xml");
  ExpectObjectsRefused({one, "--model", box, "--and-model", person}, 1,
                       "--and-model is of rigid objects");
  ExpectObjectsRefused({one, "--label", "--height", "1.8", "--and-model", box}, 2, "use one");
  ExpectObjectsRefused({one, "--model", box, "--and-model", "nowhere.xml"}, 1, "nowhere.xml");
}

}  // namespace
}  // namespace mmm_converter
