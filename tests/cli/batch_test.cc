// SPDX-License-Identifier: MIT
// batch: what is written, what is kept, and what is said.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "common/io/c3d/c3d_writer.h"
#include "common/io/recording/recording.h"
#include "tests/cli/batch_manifest.h"
#include "tests/cli/program.h"
#include "tests/common/retarget/biped.h"
#include "tests/support/changed_markers.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using testing::Contents;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::QuickConverter;
using testing::ReadText;
using testing::RunProgram;
using testing::TestFolder;
using testing::WriteManifest;
using testing::WriteText;
using Json = nlohmann::json;

std::string Out(const std::string& name = "out") { return TestFolder() + "/" + name; }

std::vector<Json> Results(const std::string& out) {
  std::vector<Json> lines;
  std::ifstream file(out + "/results.jsonl");
  for (std::string line; std::getline(file, line);) lines.push_back(Json::parse(line));
  return lines;
}

// Without what differs from run to run.
std::vector<Json> Figures(const std::string& out) {
  std::vector<Json> lines = Results(out);
  for (Json& line : lines) {
    line.erase("seconds");
    line.erase("ms_per_frame");
  }
  return lines;
}

// Nothing that is opened takes the place of a stream that is closed.
TEST(Batch, WithoutStreamsTheJournalHasRecordsOnly) {
  const std::string manifest = WriteManifest(2, QuickConverter());
  const std::string command = std::string(MMM_CONVERTER_BINARY_DIR "/bin/MMMConverterS2KF batch ") +
                              manifest + " -o " + Out() + " <&- 2>&- >" + TestFolder() + "/said";
  EXPECT_EQ(std::system(command.c_str()), 0);
  std::ifstream journal(Out() + "/journal.jsonl");
  int records = 0;
  for (std::string line; std::getline(journal, line); ++records) {
    EXPECT_TRUE(Json::accept(line)) << line;
  }
  EXPECT_EQ(records, 2);
}

TEST(Batch, ConvertsTheSampleLikeConvert) {
  const std::string manifest =
      WriteManifest(0, "name='night' mass_kg='75' csv='true' trc='true' mot='true'",
                    "<Group name='gym'><Metadata name='day' value='1'/>"
                    "<Recording file='handstand.c3d' id='gym/first' frames=':60'/></Group>");
  const auto run = RunProgram({"batch", manifest, "-o", Out(), "--reports", "worst:1"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("night: 1 recordings, 1 converted, 0 failed, 0 missing"),
                             HasSubstr("index.html"), HasSubstr("1 converted, 0 failed")));
  EXPECT_THAT(run.err, HasSubstr("[1/1] gym/first: 60 frames, "));
  const std::string single = TestFolder() + "/out/motions/gym/single.xml";
  ASSERT_EQ(RunProgram({"convert", TestFolder() + "/handstand.c3d", "--height", "1.8", "--mass",
                        "75", "--frames", ":60", "-o", single, "--export-csv",
                        TestFolder() + "/first.csv", "--export-trc", TestFolder() + "/first.trc",
                        "--export-mot", TestFolder() + "/first.mot"})
                .exit_code,
            0);
  EXPECT_EQ(ReadText(Out() + "/motions/gym/first.xml"), ReadText(single));
  EXPECT_EQ(ReadText(Out() + "/csv/gym/first.csv"), ReadText(TestFolder() + "/first.csv"));
  EXPECT_EQ(ReadText(Out() + "/trc/gym/first.trc"), ReadText(TestFolder() + "/first.trc"));
  EXPECT_EQ(ReadText(Out() + "/mot/gym/first.mot"), ReadText(TestFolder() + "/first.mot"));
  EXPECT_THAT(ReadText(Out() + "/reports/gym/first.html"), HasSubstr("<!DOCTYPE html>"));
  EXPECT_THAT(ReadText(Out() + "/index.html"),
              AllOf(HasSubstr("<!DOCTYPE html>"), HasSubstr("gym/first")));
  const std::vector<Json> lines = Results(Out());
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0]["id"], "gym/first");
  EXPECT_EQ(lines[0]["group"], "gym");
  EXPECT_EQ(lines[0]["metadata"]["day"], "1");
  EXPECT_EQ(lines[0]["frames"], 60);
  EXPECT_EQ(lines[0]["height_source"], "given");
  EXPECT_EQ(lines[0]["configuration"], "s2kf_default");
  EXPECT_EQ(lines[0]["motion"], "motions/gym/first.xml");
  EXPECT_EQ(lines[0]["report"], "reports/gym/first.html");
  EXPECT_GT(lines[0]["worst_marker_mm"], lines[0]["distance_mm"]["mean"]);
  EXPECT_THAT(ReadText(Out() + "/results.csv"), HasSubstr("\ngym/first,converted,"));
}

TEST(Batch, OneBadEntryFailsAlone) {
  const std::string manifest = WriteManifest(
      3, QuickConverter(),
      "<Recording file='missing.c3d'/><Recording file='handstand.c3d' id='far' frames='9999:'/>"
      "<Recording file='handstand.c3d' id='bad model' model='none.xml'/>"
      "<Recording file='handstand.c3d' id='bad config' config='none.xml' plugin=''/>");
  const auto run = RunProgram({"batch", manifest, "-o", Out()});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, AllOf(HasSubstr("missing: "), HasSubstr("missing.c3d: "),
                             HasSubstr("none.xml"), HasSubstr("has no frame of the recording's")));
  EXPECT_THAT(run.out, HasSubstr("7 recordings, 3 converted, 4 failed, 0 missing"));
  const std::vector<Json> lines = Results(Out());
  ASSERT_EQ(lines.size(), 7U);
  EXPECT_EQ(lines[4]["state"], "converted");
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(lines[i]["state"], "failed");
    EXPECT_THAT(lines[i]["reason"].get<std::string>(), Not(IsEmpty()));
  }
  EXPECT_EQ(Contents(Out() + "/motions").size(), 3U);
}

TEST(Batch, NamesLongerThanFilesHaveFailAlone) {
  const std::string name(300, 'a');
  std::string entries;
  for (const char* attribute : {"config", "markerSet", "model", "subjectFile", "plugin"}) {
    entries += "<Recording file='handstand.c3d' id='" + std::string(attribute) + "' frames=':40' " +
               attribute + "='" + name + "'/>";
  }
  entries += "<Recording file='" + name + ".c3d' id='file'/>";
  const auto run = RunProgram({"batch", WriteManifest(1, "", entries), "-o", Out()});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.out, HasSubstr("7 recordings, 1 converted, 6 failed"));
  EXPECT_THAT(run.err, Not(HasSubstr("unexpected")));
}

TEST(Batch, WhatHelpsIsAnAttribute) {
  // Two markers tell no height.
  const MarkerSequence markers = ReadRecording(testing::Handstand(), {}).markers.Slice(0, 150);
  std::vector<std::string> hidden = markers.labels();
  std::erase_if(hidden, [](const std::string& one) { return one == "C7" || one == "LASI"; });
  WriteC3d(TestFolder() + "/two.c3d", testing::HideMarkers(markers, hidden, 0, 150));
  const auto run = RunProgram({"convert", TestFolder() + "/two.c3d"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("no frame shows three mapped markers; give it, e.g. --height"));
  const std::string manifest = TestFolder() + "/no_height.xml";
  WriteText(manifest, "<Batch " + QuickConverter() + "><Recording file='two.c3d'/></Batch>");
  EXPECT_THAT(RunProgram({"batch", manifest, "-o", Out()}).err,
              HasSubstr("(in the manifest: height_m=\"1.75\")"));
}

TEST(Batch, WhoComesLateIsTrackedFromThenOn) {
  const MarkerSequence markers = ReadRecording(testing::Handstand(), {}).markers.Slice(0, 250);
  WriteC3d(TestFolder() + "/late.c3d", testing::HideAllMarkers(markers, 0, 220));
  const auto run = RunProgram({"convert", TestFolder() + "/late.c3d", "--height", "1.8",
                               "--summary", TestFolder() + "/late.json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const Json summary = Json::parse(ReadText(TestFolder() + "/late.json"));
  EXPECT_EQ(summary["frames"], 250);
  EXPECT_GE(summary["frames_not_converged"], 220);
}

TEST(Batch, FailFastEndsWithTheFirst) {
  const std::string manifest = WriteManifest(0, QuickConverter(),
                                             "<Recording file='missing.c3d'/>"
                                             "<Recording file='handstand.c3d'/>");
  const auto run = RunProgram({"batch", manifest, "-o", Out(), "--fail-fast", "--jobs", "1"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("--fail-fast"));
  EXPECT_THAT(run.out, HasSubstr("0 converted, 1 failed, 1 not done"));
  EXPECT_THAT(Contents(Out() + "/motions"), IsEmpty());
}

TEST(Batch, TheResultsDoNotDependOnJobsAndShards) {
  const std::string manifest = WriteManifest(8, "mass_kg='75'");
  const auto convert = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> words = {"batch", manifest, "-o", Out(name), "--reports", "none"};
    words.insert(words.end(), more.begin(), more.end());
    return RunProgram(words).exit_code;
  };
  ASSERT_EQ(convert("one", {"--jobs", "1"}), 0);
  const auto motions = Contents(Out("one") + "/motions");
  ASSERT_EQ(motions.size(), 8U);
  for (const std::string jobs : {"2", "8"}) {
    ASSERT_EQ(convert("jobs" + jobs, {"--jobs", jobs}), 0);
    EXPECT_EQ(Contents(Out("jobs" + jobs) + "/motions"), motions);
    EXPECT_EQ(Figures(Out("jobs" + jobs)), Figures(Out("one")));
  }
  for (const std::string shard : {"4/4", "2/4", "1/4"}) {
    ASSERT_EQ(convert("shards", {"--shard", shard}), 0);
  }
  const auto early =
      RunProgram({"batch", manifest, "-o", Out("shards"), "--merge", "--reports", "none"});
  EXPECT_EQ(early.exit_code, 1);
  EXPECT_THAT(early.out, HasSubstr("6 converted, 0 failed, 2 missing"));
  ASSERT_EQ(convert("shards", {"--shard", "3/4"}), 0);
  EXPECT_EQ(convert("shards", {"--merge"}), 0);
  EXPECT_EQ(Contents(Out("shards") + "/motions"), motions);
  EXPECT_EQ(Figures(Out("shards")), Figures(Out("one")));
}

// What a run with --resume did.
std::string Resumed(const std::string& manifest) {
  return RunProgram({"batch", manifest, "-o", Out(), "--resume", "--reports", "none"}).out;
}

TEST(Batch, ResumeRedoesWhatHasChanged) {
  const std::string model = TestFolder() + "/own_model.xml";
  fs::copy_file(fs::path(testing::Handstand()).parent_path() / "../xml_config/models/mmm.xml",
                model);
  const std::string manifest =
      WriteManifest(3, QuickConverter(), "<Recording file='own.c3d' model='own_model.xml'/>");
  fs::copy_file(testing::Handstand(), TestFolder() + "/own.c3d");
  EXPECT_THAT(Resumed(manifest), HasSubstr("4 converted, 0 failed in"));
  EXPECT_THAT(Resumed(manifest), HasSubstr("0 converted, 0 failed, 4 unchanged"));
  fs::remove(Out() + "/motions/1.xml");
  EXPECT_THAT(Resumed(manifest), HasSubstr("1 converted, 0 failed, 3 unchanged"));
  WriteText(Out() + "/motions/2.xml", "cut off");
  EXPECT_THAT(Resumed(manifest), HasSubstr("1 converted, 0 failed, 3 unchanged"));
  std::string recording = ReadText(TestFolder() + "/own.c3d");
  recording[recording.size() - 100] ^= 1;  // a bit of the last frame
  WriteText(TestFolder() + "/own.c3d", recording);
  EXPECT_THAT(Resumed(manifest), HasSubstr("1 converted, 0 failed, 3 unchanged"));
  WriteText(model, ReadText(model) + "<!-- another -->");
  EXPECT_THAT(Resumed(manifest), HasSubstr("1 converted, 0 failed, 3 unchanged"));
  WriteManifest(3, QuickConverter() + " mass_kg='80'",
                "<Recording file='own.c3d' model='own_model.xml'/>");
  EXPECT_THAT(Resumed(manifest), HasSubstr("4 converted, 0 failed in"));
  fs::remove(TestFolder() + "/own.c3d");  // what was made of it stays
  EXPECT_THAT(Resumed(manifest), HasSubstr("0 converted, 0 failed, 4 unchanged"));
}

TEST(Batch, ResumeTriesAgainWhatFailed) {
  const std::string manifest = WriteManifest(1, QuickConverter(), "<Recording file='late.c3d'/>");
  EXPECT_THAT(Resumed(manifest), HasSubstr("1 converted, 1 failed"));
  fs::copy_file(testing::Handstand(), TestFolder() + "/late.c3d");
  EXPECT_THAT(Resumed(manifest), HasSubstr("1 converted, 0 failed, 1 unchanged"));
  // What was made of a recording is not taken for what it shows once it is none any more.
  const std::string motion = Out() + "/motions/late.xml";
  EXPECT_TRUE(fs::exists(motion));
  WriteText(TestFolder() + "/late.c3d", "no recording");
  EXPECT_THAT(Resumed(manifest), HasSubstr("0 converted, 1 failed, 1 unchanged"));
  EXPECT_FALSE(fs::exists(motion));
  EXPECT_TRUE(fs::exists(motion + ".outdated"));
  fs::remove(TestFolder() + "/late.c3d");
  fs::copy_file(testing::Handstand(), TestFolder() + "/late.c3d");
  EXPECT_THAT(Resumed(manifest), HasSubstr("1 converted, 0 failed, 1 unchanged"));
  EXPECT_TRUE(fs::exists(motion));
  EXPECT_FALSE(fs::exists(motion + ".outdated"));
}

TEST(Batch, WithoutResumeAllIsDoneAnew) {
  const std::string manifest = WriteManifest(2, QuickConverter());
  Resumed(manifest);
  const auto run = RunProgram({"batch", manifest, "-o", Out(), "--reports", "none"});
  EXPECT_THAT(run.out, HasSubstr("2 converted, 0 failed in"));
  EXPECT_THAT(run.err, HasSubstr("an earlier run has converted 2 recordings"));
}

TEST(Batch, MemoryIsBounded) {
  const std::string manifest = WriteManifest(2, QuickConverter());
  const auto run = RunProgram({"batch", manifest, "-o", Out(), "--memory", "1M"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("more than the 1 MiB allowed"));
}

TEST(Batch, MotionsAreBroughtToARobot) {
  const std::string robot = TestFolder() + "/biped.urdf";
  WriteText(robot, testing::BipedText({}));
  WriteText(TestFolder() + "/none.urdf", "<robot name='none'><link name='base'/></robot>");
  const auto refused = RunProgram(
      {"batch",
       WriteManifest(1, "robot='biped.urdf'",
                     "<Recording file='handstand.c3d' id='none' robot='none.urdf' frames=':40'/>"),
       "-o", Out()});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err,
              ::testing::AllOf(HasSubstr(".xml:"), HasSubstr("\"none\""), HasSubstr("none")));
  EXPECT_FALSE(fs::exists(Out() + "/motions/0.xml"));
  const std::string manifest =
      WriteManifest(1, "robot='biped.urdf' lafan1='true' beyondmimic='true' robotOrder='isaac'",
                    "<Recording file='none.c3d' id='none' frames=':40'/>"
                    "<Recording file='handstand.c3d' id='person' robot='' lafan1='false' "
                    "beyondmimic='false' frames=':40'/>");
  const auto run = RunProgram({"batch", manifest, "-o", Out(), "--reports", "all"});
  EXPECT_EQ(run.exit_code, 1) << run.err;
  EXPECT_THAT(run.out, HasSubstr("3 recordings, 2 converted, 1 failed"));
  EXPECT_FALSE(fs::exists(Out() + "/motions/none.xml"));
  ASSERT_EQ(RunProgram({"retarget", TestFolder() + "/handstand.c3d", "--height", "1.8", "--frames",
                        "0:40", "--robot", robot, "-o", Out() + "/robots/single.xml",
                        "--export-lafan1", TestFolder() + "/single.csv"})
                .exit_code,
            0);
  EXPECT_EQ(ReadText(Out() + "/robots/0.xml"), ReadText(Out() + "/robots/single.xml"));
  EXPECT_EQ(ReadText(Out() + "/lafan1/0.csv"), ReadText(TestFolder() + "/single.csv"));
  EXPECT_THAT(ReadText(Out() + "/reports/0.html"), HasSubstr("handstand.c3d on biped</title>"));
  for (const Json& line : Results(Out())) {
    EXPECT_EQ(line.contains("robot_motion"), line["id"] == "0");
    EXPECT_EQ(line.contains("robot"), line["id"] == "0");
    if (line["id"] == "0") {
      EXPECT_LT(line["robot"]["slide"], 0.02);
    }
  }
  EXPECT_THAT(ReadText(Out() + "/results.csv"), HasSubstr(",robot.slide,"));
  EXPECT_THAT(Resumed(manifest), HasSubstr("0 converted, 1 failed, 2 unchanged"));
  fs::remove(Out() + "/lafan1/0.csv.names.json");
  EXPECT_THAT(Resumed(manifest), HasSubstr("1 converted, 1 failed, 1 unchanged"));
  EXPECT_TRUE(fs::exists(Out() + "/lafan1/0.csv.names.json"));
  WriteText(robot, ReadText(robot) + "<!-- another -->");
  EXPECT_THAT(Resumed(manifest), HasSubstr("1 converted, 1 failed, 1 unchanged"));
}

TEST(Batch, SelfCalibrationLeavesTheSubject) {
  const std::string manifest =
      WriteManifest(0, "", "<Recording file='handstand.c3d' selfCalibrate='true'/>");
  ASSERT_EQ(RunProgram({"batch", manifest, "-o", Out(), "--reports", "none"}).exit_code, 0);
  EXPECT_THAT(ReadText(Out() + "/subjects/handstand.xml"), HasSubstr("<Subject "));
  EXPECT_EQ(Results(Out())[0]["subject"].is_string(), true);
}

TEST(Batch, ScansAFolder) {
  fs::create_directories(TestFolder() + "/kit/7");
  fs::copy_file(testing::Handstand(), TestFolder() + "/kit/7/walk.c3d");
  WriteText(TestFolder() + "/subjects.csv", "folder,height_m\n7,1.8\n");
  const auto run = RunProgram(
      {"batch", "--scan", TestFolder() + "/kit", "--subjects", TestFolder() + "/subjects.csv"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  WriteText(TestFolder() + "/manifest.xml", run.out);
  const auto convert = RunProgram({"batch", TestFolder() + "/manifest.xml", "-o", Out()});
  EXPECT_EQ(convert.exit_code, 0) << convert.err;
  EXPECT_TRUE(fs::exists(Out() + "/motions/7/walk.xml"));
  EXPECT_TRUE(fs::exists(Out() + "/reports/7/walk.html"));
}

TEST(Batch, WhatIsNotUnderstoodIsExitCode2) {
  const std::string manifest = WriteManifest(1, QuickConverter());
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"batch"},
           {"batch", manifest},
           {"batch", manifest, "-o", Out(), "--jobs", "0"},
           {"batch", manifest, "-o", Out(), "--shard", "0/4"},
           {"batch", manifest, "-o", Out(), "--shard", "5/4"},
           {"batch", manifest, "-o", Out(), "--shard", "4"},
           {"batch", manifest, "-o", Out(), "--memory", "much"},
           {"batch", manifest, "-o", Out(), "--reports", "best"},
           {"batch", manifest, "-o", Out(), "--merge", "--shard", "1/2"},
           {"batch", manifest, "--scan", TestFolder()}}) {
    EXPECT_EQ(RunProgram(words).exit_code, 2) << Json(words).dump();
  }
  EXPECT_FALSE(fs::exists(Out()));
  WriteText(TestFolder() + "/none.xml", "<Batch/>");
  EXPECT_EQ(RunProgram({"batch", TestFolder() + "/none.xml", "-o", Out()}).exit_code, 1);
  EXPECT_EQ(RunProgram({"batch", manifest, "-o", manifest}).exit_code, 1);
}

}  // namespace
}  // namespace mmm_converter
