// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cli/program.h"
#include "tests/common/retarget/biped.h"
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
  EXPECT_THAT(ReadText(File("o.xml")), HasSubstr("left_hip_pitch"));
  const auto rows = ReadNumbers(ReadText(File("o.csv")));
  EXPECT_EQ(rows.size(), 30U);  // of 0.99 s
  for (const auto& row : rows) {
    ASSERT_EQ(row.size(), 7U + 21U);
    EXPECT_NEAR(std::hypot(std::hypot(row[3], row[4]), std::hypot(row[5], row[6])), 1, 1e-5);
  }
  EXPECT_THAT(ReadText(File("o.npz")), HasSubstr("body_quat_w.npy"));
  EXPECT_THAT(ReadText(File("o.csv.names.json")), HasSubstr("\"left_hip_pitch\""));
  EXPECT_THAT(ReadText(File("o.html")), AllOf(HasSubstr("on biped</title>"), HasSubstr("player")));
}

TEST_F(RetargetCommand, ConvertsARecordingFirst) {
  const auto run =
      RunProgram({"retarget", testing::Handstand(), "--height", "1.8", "--frames", "0:60",
                  "--robot", robot_, "-o", File("r.xml"), "--summary", File("r.json")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto summary = nlohmann::json::parse(ReadText(File("r.json")));
  EXPECT_EQ(summary["conversion_verdict"]["level"], "good");
  EXPECT_TRUE(summary["not_shown"].is_null());
  EXPECT_EQ(summary["frames"], 60);
  EXPECT_EQ(summary["velocity_limits_broken"], 0);
  EXPECT_LT(summary["penetration_m"].get<double>(), 0.001);
}

TEST_F(RetargetCommand, PrintsWhichJointsAreTheLimbs) {
  const auto run =
      RunProgram({"retarget", "--robot", robot_, "--print-map", "--report", File("map.html")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("left_knee"), HasSubstr("right_elbow")));
  EXPECT_THAT(ReadText(File("map.html")), HasSubstr("a raised knee on biped</title>"));
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
  testing::BipedShape mirrored;
  mirrored.sides = {"right_", "left_"};
  WriteText(File("mirrored.urdf"), testing::BipedText(mirrored));
  EXPECT_THAT(refusal({"retarget", testing::SourcePath("examples/handstand_true.xml"), "--robot",
                       File("mirrored.urdf"), "-o", out},
                      1),
              HasSubstr("contradict"));
}

}  // namespace
}  // namespace mmm_converter
