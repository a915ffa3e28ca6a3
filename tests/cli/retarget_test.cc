// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common/io/mmm/mmm_motion.h"
#include "tests/cli/moving_object.h"
#include "tests/cli/program.h"
#include "tests/common/retarget/biped.h"
#include "tests/support/box_mesh.h"
#include "tests/support/shared_data.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::ReadText;
using testing::RunProgram;
using testing::TestFolder;
using testing::WriteText;

class RetargetCommand : public ::testing::Test {
 protected:
  RetargetCommand() { WriteText(robot_, testing::BipedText({})); }

  static std::string File(const std::string& name) { return TestFolder() + "/retarget_" + name; }

  std::vector<std::string> Words(std::vector<std::string> more) const {
    std::vector<std::string> words = {
        "retarget", testing::SourcePath("examples/handstand_true.xml"),
        "--frames", "0:100",
        "--robot",  robot_};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  std::string robot_ = File("biped.urdf");
};

std::vector<std::vector<double>> ReadNumbers(const std::string& text) {
  std::vector<std::vector<double>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::vector<double>& row = rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
  }
  return rows;
}

TEST_F(RetargetCommand, WritesTheRobotsMotionAndWhatLearnersRead) {
  const auto run = RunProgram(Words(
      {"-o", File("o.xml"), "--summary", File("o.json"), "--export-lafan1", File("o.csv"),
       "--export-beyondmimic", File("o.npz"), "--order", "isaac", "--report", File("o.html")}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("verdict"), HasSubstr(File("o.csv.names.json"))));
  const auto summary = nlohmann::json::parse(ReadText(File("o.json")));
  EXPECT_THAT(summary["verdict"]["level"], ::testing::AnyOf("good", "check"));
  const auto& fits = summary["files_at_other_rates"];
  ASSERT_EQ(fits.size(), 2U);
  EXPECT_EQ(fits[0]["files"][0], File("o.csv"));
  EXPECT_EQ(fits[0]["rate_hz"], 30);
  EXPECT_EQ(fits[1]["rate_hz"], 50);
  for (const auto& fit : fits) {
    EXPECT_LT(fit["penetration_m"], 0.002);
    EXPECT_EQ(fit["velocity_limits_broken"], 0);
  }
  EXPECT_THAT(run.out, HasSubstr("at 30 Hz"));
  EXPECT_THAT(ReadText(File("o.xml")), HasSubstr("left_hip_pitch"));
  const auto rows = ReadNumbers(ReadText(File("o.csv")));
  EXPECT_EQ(rows.size(), 30U);  // of 0.99 s
  for (const auto& row : rows) {
    ASSERT_EQ(row.size(), 7U + 21U);
    EXPECT_NEAR(std::hypot(std::hypot(row[3], row[4]), std::hypot(row[5], row[6])), 1, 1e-5);
  }
  EXPECT_THAT(ReadText(File("o.npz")), HasSubstr("body_quat_w.npy"));
  const auto info = RunProgram({"info", File("o.csv")});
  EXPECT_THAT(info.out, AllOf(HasSubstr("LAFAN1"), HasSubstr("frames     30"),
                              HasSubstr("joints     21: left_hip")));
  EXPECT_THAT(ReadText(File("o.csv.names.json")), HasSubstr("\"left_hip_pitch\""));
  EXPECT_THAT(ReadText(File("o.html")), AllOf(HasSubstr("on biped</title>"), HasSubstr("player")));
}

// jacobian_pull: a converter that knows no deviations.
TEST_F(RetargetCommand, ConvertsARecordingFirst) {
  for (const std::string config : {"s2kf_offline", "jacobian_pull"}) {
    const auto run =
        RunProgram({"retarget", testing::Handstand(), "--height", "1.8", "--frames", "0:60", "-c",
                    config, "--robot", robot_, "-o", File("r.xml"), "--summary", File("r.json")});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto summary = nlohmann::json::parse(ReadText(File("r.json")));
    EXPECT_EQ(summary["conversion_verdict"]["level"], "check") << config;
    EXPECT_TRUE(summary["not_shown"].is_null());
    EXPECT_EQ(summary["frames"], 60);
    EXPECT_EQ(summary["velocity_limits_broken"], 0);
    EXPECT_LT(summary["penetration_m"].get<double>(), 0.001) << config;
    EXPECT_LT(summary["direction_rad"].get<double>(), 0.1) << config;
  }
}

TEST_F(RetargetCommand, PrintsWhichJointsAreTheLimbs) {
  const auto run =
      RunProgram({"retarget", "--robot", robot_, "--print-map", "--report", File("map.html")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("left_knee"), HasSubstr("right_elbow")));
  EXPECT_THAT(ReadText(File("map.html")), HasSubstr("a raised knee on biped</title>"));
}

TEST_F(RetargetCommand, PrintsTheMapOfARobotWhoseSoleIsNotKnown) {
  testing::BipedShape shape;
  shape.has_sole = false;
  WriteText(robot_, testing::BipedText(shape));
  const auto run = RunProgram({"retarget", "--robot", robot_, "--print-map"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("left_knee"), HasSubstr("sole: not known"),
                             HasSubstr("--sole gives its size")));
  EXPECT_EQ(RunProgram(Words({"-o", File("none.xml"), "--print-map"})).exit_code, 1);
}

TEST_F(RetargetCommand, FeetAreTheirMeshes) {
  testing::BipedShape shape;
  shape.has_sole = false;
  std::string text = testing::BipedText(shape);
  for (const std::string side : {"left", "right"}) {
    const std::string link = "<link name=\"" + side + "_ankle_roll_link\">";
    text.replace(text.find(link), link.size(),
                 link +
                     "<collision><geometry><mesh filename=\"package://made/foot.STL\" "
                     "scale=\"0.001 0.001 0.001\"/></geometry></collision>");
  }
  std::filesystem::create_directories(TestFolder() + "/made/urdf");
  const std::string robot = TestFolder() + "/made/urdf/r.urdf";
  WriteText(robot, text);
  std::vector<std::string> words = Words({"-o", File("m.xml"), "--summary", File("m.json")});
  std::replace(words.begin(), words.end(), robot_, robot);
  const auto bare = RunProgram(words);
  EXPECT_EQ(bare.exit_code, 1);
  EXPECT_THAT(bare.err, AllOf(HasSubstr("package://made/foot.STL of left_ankle_roll_link is not"),
                              HasSubstr("(--sole)")));
  const std::string mesh = TestFolder() + "/made/foot.STL";
  const testing::BoxMesh box = {{-60, -40, -80}, {140, 40, -60}};
  WriteText(mesh, box.BinaryStl());
  const auto run = RunProgram(words);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("sole        1 mesh of left_ankle_roll_link"));
  // As the biped of the other tests, whose sole is a box of that size.
  EXPECT_EQ(RunProgram(Words({"-o", File("b.xml"), "--summary", File("b.json")})).exit_code, 0);
  const auto summary = nlohmann::json::parse(ReadText(File("m.json")));
  const auto with_box = nlohmann::json::parse(ReadText(File("b.json")));
  EXPECT_EQ(summary["scale"], with_box["scale"]);
  EXPECT_NEAR(summary["penetration_m"].get<double>(), with_box["penetration_m"].get<double>(),
              2e-4);
  EXPECT_EQ(summary["verdict"]["level"], with_box["verdict"]["level"]);
  words.insert(words.end(), {"--report", mesh});
  EXPECT_THAT(RunProgram(words).err, HasSubstr("foot.STL"));
  EXPECT_EQ(ReadText(mesh), box.BinaryStl());
  words.resize(words.size() - 2);
  words.insert(words.end(), {"--sole", "0.2,0.08,0.08"});
  EXPECT_EQ(RunProgram(words).exit_code, 0);
  const auto given = nlohmann::json::parse(ReadText(File("m.json")));
  EXPECT_EQ(given["verdict"]["level"], "check");
  EXPECT_THAT(given["verdict"]["reasons"].dump(), HasSubstr("the sole is as given"));
  const auto live = RunProgram({"live", "replay:" + testing::Handstand() + "@max", "--height",
                                "1.8", "--robot", robot, "--sole", "0.2,0.08,0.08"});
  EXPECT_THAT(live.out, HasSubstr("the sole is as given"));
}

TEST_F(RetargetCommand, ObjectsComeAlong) {
  WriteText(File("box.xml"), testing::SlidingBox("b.xml", 200));
  const auto run = RunProgram(Words({"-o", File("b_o.xml"), "--objects", File("box.xml") + ":box",
                                     "--summary", File("b_o.json"), "--export-mujoco",
                                     File("b_o.npz"), "--export-gmr", File("b_o.pkl")}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("box"));
  EXPECT_THAT(ReadText(File("b_o.npz")), HasSubstr("object_names.npy"));
  const auto info = RunProgram({"info", File("b_o.pkl")});
  EXPECT_THAT(info.out, HasSubstr("motion of a robot, as GMR and TWIST have it"));
  const auto summary = nlohmann::json::parse(ReadText(File("b_o.json")));
  EXPECT_EQ(summary["objects"][0]["name"], "box");
  const MmmMotionFile file = ReadMmmMotionFile(File("b_o.xml"));
  ASSERT_EQ(file.motions.size(), 2U);
  EXPECT_EQ(file.motions[1].type, "object");
  EXPECT_EQ(file.motions[1].model_path, "b.xml");
  const PoseTrajectory& box = file.motions[1].trajectory;
  EXPECT_EQ(box.num_frames(), file.motions[0].trajectory.num_frames());
  const double way = box.postures.back().position.x() - box.postures.front().position.x();
  EXPECT_NEAR(way, summary["scale"].get<double>() * 0.001 * (box.num_frames() - 1),
              1e-5);  // the scale has four digits
  const auto none = RunProgram(Words({"-o", File("x.xml"), "--objects", File("box.xml") + ":cup"}));
  EXPECT_THAT(none.err, HasSubstr("has no object \"cup\"; there is box"));
  const auto itself = RunProgram(Words({"-o", File("box.xml"), "--objects", File("box.xml")}));
  EXPECT_EQ(itself.exit_code, 1);
  EXPECT_THAT(itself.err, HasSubstr("box.xml"));
}

TEST_F(RetargetCommand, RefusesBeforeTheWork) {
  const auto refusal = [&](const std::vector<std::string>& words, int code) {
    const auto run = RunProgram(words);
    EXPECT_EQ(run.exit_code, code) << run.out;
    EXPECT_FALSE(std::filesystem::exists(File("none.xml")));
    return run.err;
  };
  const std::string out = File("none.xml");
  EXPECT_THAT(refusal(Words({"-o", out, "--export-beyondmimic", File("n.npz")}), 2),
              HasSubstr("--order isaac"));
  EXPECT_THAT(refusal(Words({"-o", out, "--export-rate", "0"}), 2), HasSubstr("--export-rate"));
  EXPECT_THAT(refusal(Words({"-o", out, "--order", "isaac"}), 2), HasSubstr("none is asked for"));
  EXPECT_THAT(refusal(Words({"-o", out, "--export-gmr", File("n.pkl"), "--order", "bfs"}), 2),
              HasSubstr("isaac"));
  EXPECT_THAT(refusal(Words({"-o", out, "--export-lafan1", File("n.csv"), "--summary",
                             File("n.csv.names.json")}),
                      1),
              HasSubstr("two outputs"));
  EXPECT_THAT(refusal(Words({"-o", robot_}), 1), HasSubstr(robot_));
  EXPECT_THAT(refusal(Words({"-o", out, "--report", robot_}), 1), HasSubstr(robot_));
  EXPECT_THAT(refusal({"retarget", "--robot", robot_, "--report", robot_}, 1), HasSubstr(robot_));
  EXPECT_THAT(refusal(Words({"-o", out, "--hold", "left_finger=3"}), 1),
              AllOf(HasSubstr("--hold"), HasSubstr("left_hip_yaw")));
  EXPECT_THAT(refusal(Words({"-o", out, "--weights", "foot=2"}), 1),
              AllOf(HasSubstr("--weights"), HasSubstr("\"foot=2\""), HasSubstr("0.01 to 100")));
  EXPECT_THAT(refusal(Words({"-o", out, "--sole-height", "50"}), 1), HasSubstr("5 to 500 mm"));
  for (const char* sole : {"0.2,0.08", "0.2,0.08,x", "200,80,50", "mesh"}) {
    EXPECT_THAT(refusal(Words({"-o", out, "--sole", sole}), 1), HasSubstr("--sole")) << sole;
  }
  EXPECT_THAT(refusal(Words({"-o", out, "--sole", "shapes", "--sole-height", "0.05"}), 1),
              HasSubstr("one of them"));
  EXPECT_THAT(refusal(Words({"-o", out, "--sole", "meshes"}), 1), HasSubstr("(--sole)"));
  EXPECT_THAT(refusal(Words({"-o", out, "--objects", File("no.xml")}), 1),
              HasSubstr(File("no.xml")));
  EXPECT_THAT(
      refusal(Words({"-o", out, "--objects", testing::SourcePath("examples/handstand_true.xml")}),
              1),
      HasSubstr("without joints"));
  testing::BipedShape stands;
  stands.has_legs = false;
  WriteText(File("stands.urdf"), testing::BipedText(stands));
  EXPECT_THAT(refusal({"retarget", testing::SourcePath("examples/handstand_true.xml"), "--robot",
                       File("stands.urdf"), "-o", out, "--objects", File("box.xml")},
                      1),
              AllOf(HasSubstr("stands.urdf"), HasSubstr("--objects needs a robot with legs")));
  testing::BipedShape mirrored;
  mirrored.sides = {"right_", "left_"};
  WriteText(File("mirrored.urdf"), testing::BipedText(mirrored));
  EXPECT_THAT(refusal({"retarget", testing::SourcePath("examples/handstand_true.xml"), "--robot",
                       File("mirrored.urdf"), "-o", out},
                      1),
              HasSubstr("contradict"));
}

TEST(RealRetarget, WalkersFeetStandStillOnRobotsWithAndWithoutAnklesThatRoll) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string& folder = TestFolder();
  for (const char* input :
       {"field/nimble_Tiziana2019_markers.trc", "recordings/whole_body/pycgm_movement_trial.c3d"}) {
    for (const char* robot : {"unitree_g1/g1_custom_collision_29dof.urdf", "unitree_h1/h1.urdf",
                              "booster_t1/T1_23dof.urdf"}) {
      const auto run = RunProgram({"retarget", testing::SharedData(input), "--robot",
                                   testing::SharedData(std::string("robots/") + robot), "-o",
                                   folder + "/walker.xml", "--summary", folder + "/walker.json"});
      ASSERT_EQ(run.exit_code, 0) << run.err;
      const auto summary = nlohmann::json::parse(ReadText(folder + "/walker.json"));
      // Two of the walker's 190 pairs of frames.
      EXPECT_LT(summary["slide"].get<double>(), 0.012) << input << " " << robot;
      EXPECT_LT(summary["penetration_m"].get<double>(), 0.001) << input << " " << robot;
      // The person goes down five steps of .19 m.
      const bool has_steps = summary["highest_stance_m"] != 0;
      EXPECT_EQ(has_steps, std::string(input).find("pycgm") != std::string::npos) << input;
      EXPECT_NEAR(summary["highest_stance_m"].get<double>() / summary["scale"].get<double>(),
                  has_steps ? 5 * 0.19 : 0, 0.02);
    }
  }
}

TEST(RealRetarget, ForearmsThatOneMarkerShowsDoNotTurnARobotsHands) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string motion = TestFolder() + "/untold.xml";
  const auto run = RunProgram(
      {"retarget", testing::SharedData("field/c3dio_evart.c3d"), "--robot",
       testing::SharedData("robots/unitree_g1/g1_custom_collision_29dof.urdf"), "-o", motion});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("the markers don't tell LEz_joint,"));
  const PoseTrajectory robot = ReadMmmMotionFile(motion).motions.at(0).trajectory;
  for (std::size_t j = 0; j < robot.joint_names.size(); ++j) {
    if (robot.joint_names[j].find("wrist_roll") == std::string::npos) continue;
    double most = 0;
    for (const Posture& posture : robot.postures) {
      most = std::max(most, std::abs(posture.joint_angles[static_cast<Eigen::Index>(j)]));
    }
    EXPECT_LT(most, 0.9) << robot.joint_names[j];  // 1.4 of the rotation as it is
  }
}

// KIT's own poses of what a person pours from and into, at 10 Hz, beside a table that nobody takes
// along. 10 mm: a palm's width is some 80.
TEST(RealRetarget, HandsStayAtWhatTheyPourWith) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string file =
      testing::SharedData("mmm/kit_bimanual_10hz/Pour_files_motions_2967_Pour1_cs_ms_0_20l_04.xml");
  const std::string& folder = TestFolder();
  for (const char* robot : {"unitree_g1/g1_custom_collision_29dof.urdf", "unitree_h1/h1.urdf",
                            "booster_t1/T1_23dof.urdf"}) {
    const auto run = RunProgram({"retarget", file, "--motion", "true_1480", "--robot",
                                 testing::SharedData(std::string("robots/") + robot), "--objects",
                                 file + ":true_cup_small,true_milk_small,true_kitchen_sideboard",
                                 "-o", folder + "/pour.xml", "--summary", folder + "/pour.json"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto summary = nlohmann::json::parse(ReadText(folder + "/pour.json"));
    EXPECT_EQ(summary["slide"], 0);
    std::map<std::string, nlohmann::json> held;
    for (const auto& object : summary["objects"]) held[object["name"]] = object["held"];
    ASSERT_EQ(held["true_cup_small"].size(), 1U);
    ASSERT_EQ(held["true_milk_small"].size(), 1U);
    EXPECT_EQ(held["true_kitchen_sideboard"].size(), 0U);
    EXPECT_EQ(held["true_cup_small"][0]["hand"], "left");
    EXPECT_EQ(held["true_milk_small"][0]["hand"], "right");
    for (const char* name : {"true_cup_small", "true_milk_small"}) {
      EXPECT_LT(held[name][0]["off_most_m"].get<double>(), 0.01) << robot;
    }
  }
}

}  // namespace
}  // namespace mmm_converter
