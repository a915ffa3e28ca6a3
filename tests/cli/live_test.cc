// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "common/io/c3d/c3d_writer.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/io/recording/recording.h"
#include "common/support/units.h"
#include "tests/cli/program.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using testing::Handstand;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ReadText;
using testing::RunProgram;
using testing::StartedProgram;
using testing::TestFolder;
using testing::WriteText;

void ExpectSamePostures(const PoseTrajectory& live, const PoseTrajectory& converted,
                        double tolerance) {
  ASSERT_EQ(live.num_frames(), converted.num_frames());
  EXPECT_EQ(live.joint_names, converted.joint_names);
  double largest = 0;
  for (int k = 0; k < live.num_frames(); ++k) {
    const Posture& a = live.postures[static_cast<std::size_t>(k)];
    const Posture& b = converted.postures[static_cast<std::size_t>(k)];
    largest = std::max(
        {largest, Local(a, b).lpNorm<Eigen::Infinity>(),
         std::abs(live.time(k) - live.first_time - converted.time(k) + converted.first_time)});
  }
  EXPECT_LE(largest, tolerance);
}

// What the two wrote; MMM files have 8 decimals.
void ExpectReplayIsConversion(const std::string& recording, std::vector<std::string> options) {
  const std::string live = TestFolder() + "/live.xml";
  const std::string converted = TestFolder() + "/converted.xml";
  std::vector<std::string> words = {"live", "replay:" + recording + "@max", "-o", live};
  words.insert(words.end(), options.begin(), options.end());
  const auto run = RunProgram(words);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr(", 0 dropped"));
  words = {"convert", recording, "-o", converted};
  words.insert(words.end(), options.begin(), options.end());
  const auto convert = RunProgram(words);
  ASSERT_EQ(convert.exit_code, 0) << convert.err;
  const MmmMotionFile a = ReadMmmMotionFile(live);
  const MmmMotionFile b = ReadMmmMotionFile(converted);
  ExpectSamePostures(a.motions.front().trajectory, b.motions.front().trajectory, 2e-8);
  EXPECT_EQ(a.motions.front().name, b.motions.front().name);
}

TEST(Live, AReplayGivesWhatAConversionGives) {
  ExpectReplayIsConversion(Handstand(), {"--height", "1.8"});
}

TEST(LiveRealFiles, RealReplaysGiveWhatConversionsGive) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  for (const char* file : {"kit_bimanual_c3d/Cut_1723.c3d", "kit_bimanual_c3d/Pour_1480.c3d"}) {
    SCOPED_TRACE(file);
    ExpectReplayIsConversion(testing::SharedData(std::string("recordings/") + file),
                             {"--height", "1.75"});
  }
}

TEST(Live, ARobotFollowsThePerson) {
  const std::string robot = testing::SourcePath("examples/robot/biped.urdf");
  const std::string& folder = TestFolder();
  const std::vector<std::string> words = {
      "live", "replay:" + Handstand() + "@max", "--height", "1.8", "--robot", robot};
  std::vector<std::string> writes = words;
  writes.insert(writes.end(), {"-o", folder + "/robot.xml"});
  const auto run = RunProgram(writes);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out,
              ::testing::AllOf(HasSubstr(folder + "/robot.xml"), HasSubstr("feet slide in"),
                               HasSubstr("of velocity 0 times"), HasSubstr("verdict")));
  const MmmMotionFile file = ReadMmmMotionFile(folder + "/robot.xml");
  const PoseTrajectory& motion = file.motions.front().trajectory;
  EXPECT_EQ(motion.num_frames(), 675);
  EXPECT_THAT(motion.joint_names, ::testing::Contains("left_hip_pitch"));
  std::vector<std::string> sends = words;
  sends.insert(sends.end(), {"--to", "mvn://127.0.0.1"});
  const auto refused = RunProgram(sends);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("takes persons only"));
}

TEST(Live, ARobotHoldsWhileItsPersonIsLostAndThatIsTold) {
  const std::string& folder = TestFolder();
  MarkerSequence markers = ReadRecording(Handstand(), {}).markers.Slice(0, 250);
  for (int k = 100; k < 220; ++k) markers.frame(k).setConstant(kNaN);
  WriteC3d(folder + "/gap.c3d", markers, {});
  const std::string robot = testing::SourcePath("examples/robot/biped.urdf");
  std::vector<std::string> words = {"live",
                                    "replay:" + folder + "/gap.c3d@max",
                                    "--height",
                                    "1.8",
                                    "--robot",
                                    robot,
                                    "-o",
                                    folder + "/gap.xml",
                                    "--strict",
                                    "--summary",
                                    folder + "/gap.json"};
  const auto run = RunProgram(words);
  EXPECT_EQ(run.exit_code, 3) << run.err;  // nearly half of the time
  EXPECT_THAT(run.err, ::testing::AllOf(HasSubstr("the person is lost; the robot holds"),
                                        HasSubstr("the robot returns to the person, after 1.")));
  EXPECT_THAT(run.out, HasSubstr("the person was lost 1 time: the robot held for 1."));
  const nlohmann::json summary = nlohmann::json::parse(ReadText(folder + "/gap.json"))["robot"];
  EXPECT_EQ(summary["holds"], 1);
  EXPECT_EQ(summary["returns"], 1);
  EXPECT_LT(summary["acceleration_rad_s2"], 60);
  // A posture of each frame, whoever is seen.
  EXPECT_EQ(ReadMmmMotionFile(folder + "/gap.xml").motions.front().trajectory.num_frames(), 250);
  words.insert(words.end(), {"--joint-speed", "0"});
  const auto refused = RunProgram(words);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("--joint-speed is rad/s, from 0.01 to 1000"));
}

TEST(Live, ASecondAfterAGapTheRobotIsWhereItWouldBe) {
  const std::string& folder = TestFolder();
  const std::string robot = testing::SourcePath("examples/robot/biped.urdf");
  MarkerSequence markers = ReadRecording(Handstand(), {}).markers.Slice(0, 260);
  std::vector<Posture> last;
  for (const int end : {0, 60, 130}) {  // from frame 30 on; none
    for (int k = 30; k < end; ++k) markers.frame(k).setConstant(kNaN);
    WriteC3d(folder + "/gone.c3d", markers, {});
    const auto run = RunProgram({"live", "replay:" + folder + "/gone.c3d@max", "--height", "1.8",
                                 "--robot", robot, "-o", folder + "/gone.xml"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const MmmMotionFile file = ReadMmmMotionFile(folder + "/gone.xml");
    last.push_back(file.motions.front().trajectory.postures[230]);
    const Eigen::VectorXd off = last.back().joint_angles - last.front().joint_angles;
    EXPECT_LT(std::sqrt(off.squaredNorm() / static_cast<double>(off.size())), 0.052) << end;
  }
}

TEST(Live, ExportsAndPagesAreThoseOfAConversion) {
  const std::string& folder = TestFolder();
  const auto run = RunProgram({"live", "replay:" + Handstand() + "@max", "--height", "1.8", "-o",
                               folder + "/a.xml", "--export-csv", folder + "/a.csv", "--report",
                               folder + "/a.html", "--summary", folder + "/a.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto convert = RunProgram({"convert", Handstand(), "--height", "1.8", "-o",
                                   folder + "/b.xml", "--export-csv", folder + "/b.csv"});
  ASSERT_EQ(convert.exit_code, 0) << convert.err;
  EXPECT_EQ(ReadText(folder + "/a.csv"), ReadText(folder + "/b.csv"));
  EXPECT_THAT(ReadText(folder + "/a.html"), HasSubstr("handstand"));
  const nlohmann::json summary = nlohmann::json::parse(ReadText(folder + "/a.json"));
  EXPECT_EQ(summary["frames"], 675);
  EXPECT_EQ(summary["tracked"], 675);
  EXPECT_EQ(summary["dropped"], 0);
  EXPECT_EQ(summary["motions"][0]["verdict"]["level"], "check");
  EXPECT_FALSE(std::filesystem::exists(folder + "/a.xml.live"));
}

TEST(Live, AHeightThatNobodyGaveIsMeasuredFirst) {
  const std::string motion = TestFolder() + "/motion.xml";
  const auto run = RunProgram({"live", "replay:" + Handstand() + "@max", "-o", motion});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("height: 1."));
  EXPECT_GT(ReadMmmMotionFile(motion).motions.front().trajectory.num_frames(), 300);
}

TEST(Live, CalibratesWhileThePersonMoves) {
  const std::string& folder = TestFolder();
  StartedProgram program({"live", "replay:" + Handstand() + "@20", "--height", "1.8",
                          "--self-calibrate", "--calibrate-seconds", "3", "--loop", "-o",
                          folder + "/a.xml", "--subject-out", folder + "/anna.xml"});
  program.WaitForText("calibrated: mean marker distance");
  program.Send(SIGINT);
  ASSERT_EQ(program.Wait(), 0) << program.Said();
  EXPECT_THAT(ReadText(folder + "/anna.xml"), HasSubstr("<Subject"));
  EXPECT_THAT(ReadText(folder + "/a.xml"), HasSubstr("those of the subject"));
}

constexpr int kUnlabelledFrames = 200;

// The sample's first points in the opposite order, without their labels.
std::string UnlabelledHandstand() {
  const MarkerSequence labelled =
      ReadRecording(Handstand(), {}).markers.Slice(0, kUnlabelledFrames);
  std::vector<std::string> labels;
  labels.reserve(static_cast<std::size_t>(labelled.num_labels()));
  for (int i = 0; i < labelled.num_labels(); ++i) labels.push_back(fmt::format("*{}", i + 1));
  MarkerSequence points(labels, labelled.num_frames(), labelled.rate(), labelled.first_time());
  for (int k = 0; k < points.num_frames(); ++k) {
    points.frame(k) = labelled.frame(k).rowwise().reverse();
  }
  std::string file = TestFolder() + "/unlabelled.c3d";
  WriteC3d(file, points, {});
  return file;
}

TEST(Live, PointsWithoutLabelsAreNamedByTheBody) {
  const std::string& folder = TestFolder();
  const std::string source = "replay:" + UnlabelledHandstand() + "@max";
  const std::string motion = folder + "/a.xml";
  EXPECT_EQ(RunProgram({"live", source, "--height", "1.8", "-o", motion}).exit_code, 1);
  std::vector<std::string> texts;
  for (int i = 0; i < 2; ++i) {
    const auto run = RunProgram({"live", source, "--label", "--height", "1.8", "-o", motion});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("points are named by the body"));
    texts.push_back(ReadText(motion));
  }
  EXPECT_TRUE(texts[0] == texts[1]);
  const auto convert =
      RunProgram({"convert", Handstand(), "--height", "1.8", "-o", folder + "/c.xml"});
  ASSERT_EQ(convert.exit_code, 0) << convert.err;
  const PoseTrajectory found = ReadMmmMotionFile(motion).motions.front().trajectory;
  const PoseTrajectory known = ReadMmmMotionFile(folder + "/c.xml").motions.front().trajectory;
  // In the first frame the body is searched, which takes the posture of the next.
  ASSERT_EQ(found.num_frames(), kUnlabelledFrames);
  std::vector<double> distances;
  distances.reserve(static_cast<std::size_t>(found.num_frames()));
  for (int k = 0; k < found.num_frames(); ++k) {
    distances.push_back((found.postures[k].position - known.postures[k].position).norm());
  }
  std::sort(distances.begin(), distances.end());
  EXPECT_LT(distances[distances.size() * 95 / 100], 0.02);
}

// The journal of a stream that a killed process left.
std::string LeaveJournal(const std::string& motion) {
  StartedProgram program({"live", "replay:" + Handstand(), "--height", "1.8", "-o", motion});
  program.WaitForLines(motion + ".live", 60);
  program.Send(SIGKILL);
  EXPECT_EQ(program.Wait(), -SIGKILL);
  return ReadText(motion + ".live");
}

TEST(Live, WhatAKilledProcessLeftBecomesAMotion) {
  const std::string motion = TestFolder() + "/motion.xml";
  LeaveJournal(motion);
  EXPECT_FALSE(std::filesystem::exists(motion));
  const auto info = RunProgram({"info", motion + ".live"});
  ASSERT_EQ(info.exit_code, 0) << info.err;
  EXPECT_THAT(info.out, HasSubstr("MMMConverterS2KF live SOURCE -o " + motion + "\n"));
  const auto run =
      RunProgram({"live", "replay:" + Handstand() + "@max", "--height", "1.8", "-o", motion});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("the motion of a run that was killed is now in"));
  const std::string recovered = TestFolder() + "/motion_recovered.xml";
  const PoseTrajectory whole = ReadMmmMotionFile(motion).motions.front().trajectory;
  PoseTrajectory part = ReadMmmMotionFile(recovered).motions.front().trajectory;
  ASSERT_GE(part.num_frames(), 59);
  ASSERT_LE(part.num_frames(), whole.num_frames());
  // At its own pace a frame may have been dropped, from which on the filter goes another way.
  EXPECT_LT(Local(part.postures[0], whole.postures[0]).lpNorm<Eigen::Infinity>(), 2e-8);
  EXPECT_EQ(part.rate, whole.rate);
  EXPECT_FALSE(std::filesystem::exists(motion + ".live"));
}

TEST(Live, ADamagedJournalIsRecoveredAsFarAsItGoes) {
  const std::string motion = TestFolder() + "/motion.xml";
  const std::string text = LeaveJournal(motion);
  const std::size_t second = text.find('\n', text.find('\n') + 1) + 1;
  WriteText(motion + ".live", text.substr(0, second) + "7 nan 1 garbage\n\n1e999 2\n" +
                                  text.substr(second, text.size() - second - 40));
  const auto run = RunProgram({"live", "replay:missing.c3d", "--height", "1.8", "-o", motion});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_GE(ReadMmmMotionFile(TestFolder() + "/motion_recovered.xml")
                .motions.front()
                .trajectory.num_frames(),
            58);
}

// The journal's first frame once more, so late.
std::string WithOneLate(const std::string& journal, const std::string& time) {
  const std::size_t frame = journal.find('\n') + 1;
  const std::size_t frame_ends = journal.find('\n', frame) + 1;
  const std::size_t number_ends = journal.find(' ', frame);
  const std::size_t time_ends = journal.find(' ', number_ends + 1);
  return journal.substr(0, frame_ends) + journal.substr(frame, number_ends - frame) + " " + time +
         journal.substr(time_ends, frame_ends - time_ends);
}

// Of a machine that falls far behind most frames are missing. The motion is written all the same.
TEST(Live, FewOfManyFramesBecomeAMotionOfALowerRate) {
  const std::string motion = TestFolder() + "/motion.xml";
  WriteText(motion + ".live", WithOneLate(LeaveJournal(motion), "900"));
  const auto run =
      RunProgram({"live", "replay:" + Handstand() + "@max", "--height", "1.8", "-o", motion});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("2 frames came of 9"));
  EXPECT_THAT(run.err, HasSubstr("the motion has 50 Hz"));
  const PoseTrajectory recovered =
      ReadMmmMotionFile(TestFolder() + "/motion_recovered.xml").motions.front().trajectory;
  EXPECT_DOUBLE_EQ(recovered.rate, 50);
  EXPECT_NEAR(recovered.first_time + (recovered.num_frames() - 1) / recovered.rate, 900, 0.02);
  EXPECT_TRUE(recovered.postures.front().position.isApprox(recovered.postures.back().position));
}

// What is there under the journal's name is the program's own, or stays as it is.
TEST(Live, OnlyAJournalIsTakenForOne) {
  const std::string motion = TestFolder() + "/motion.xml";
  const std::vector<std::string> words = {
      "live", "replay:" + Handstand() + "@max", "--height", "1.8", "-o", motion};
  const std::string far = WithOneLate(LeaveJournal(motion), "1e6");
  for (const auto& [text, why] : std::map<std::string, std::string>{
           {"a letter\nto somebody", "is no journal of a live motion"},
           {"{\"a\": 1}", "is no journal of a live motion"},
           {far, "can't fill"}}) {
    WriteText(motion + ".live", text);
    const auto run = RunProgram(words);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.err, HasSubstr(motion + ".live: "));
    EXPECT_THAT(run.err, HasSubstr(why));
    EXPECT_EQ(ReadText(motion + ".live"), text);
  }
  for (const char* begun : {"", "{\"jour"}) {
    WriteText(motion + ".live", begun);
    const auto run = RunProgram(words);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_FALSE(std::filesystem::exists(motion + ".live"));
  }
}

TEST(Live, InterruptedItWritesWhatItHas) {
  const std::string motion = TestFolder() + "/motion.xml";
  StartedProgram program(
      {"live", "replay:" + Handstand(), "--loop", "--height", "1.8", "-o", motion});
  program.WaitForLines(motion + ".live", 30);
  program.Send(SIGINT);
  EXPECT_EQ(program.Wait(), 0) << program.Said();
  EXPECT_GE(ReadMmmMotionFile(motion).motions.front().trajectory.num_frames(), 29);
  EXPECT_FALSE(std::filesystem::exists(motion + ".live"));
}

void ExpectRefused(const std::vector<std::string>& words, int exit_code, const std::string& why) {
  std::vector<std::string> all = {"live"};
  all.insert(all.end(), words.begin(), words.end());
  const auto run = RunProgram(all);
  EXPECT_EQ(run.exit_code, exit_code) << run.err;
  EXPECT_THAT(run.err, HasSubstr(why));
  EXPECT_THAT(run.err, Not(HasSubstr("unexpected")));
}

TEST(Live, WhatCantBeIsSaid) {
  ExpectRefused({}, 2, "which source");
  ExpectRefused({"walk.c3d"}, 1, "replay:");
  ExpectRefused({"replay:nothing.c3d"}, 1, "nothing.c3d");
  ExpectRefused({"replay:" + Handstand() + "@quick"}, 1, "\"quick\"");
  ExpectRefused({"replay:" + Handstand(), "--to", "smoke://signals"}, 1, "mvn, ws or zmq");
  ExpectRefused({"replay:" + Handstand(), "--to", "mvn://a:b"}, 1, "the port is \"b\"");
  ExpectRefused({"replay:" + Handstand(), "--export-csv", "x.csv"}, 2, "give -o too");
  ExpectRefused({"replay:" + Handstand(), "--subject-out", "x.xml"}, 2, "need --self-calibrate");
  ExpectRefused({"replay:" + Handstand(), "--height", "1.8", "-o", "/nowhere/x.xml"}, 1,
                "/nowhere/x.xml");
}

TEST(Live, ADiskThatIsFullEndsTheMotionAndNotTheTracking) {
  const std::string& folder = TestFolder();
  std::filesystem::create_directory(folder + "/m.xml.live");
  const auto run = RunProgram(
      {"live", "replay:" + Handstand() + "@max", "--height", "1.8", "-o", folder + "/m.xml"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("m.xml.live"));
}

}  // namespace
}  // namespace mmm_converter
