// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cli/program.h"
#include "tests/support/shared_data.h"
#include "tests/support/test_plugins.h"

namespace mmm_converter {
namespace {

using testing::Handstand;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ProgramRun;
using testing::ReadText;
using testing::TestFolder;
using testing::WriteText;
using Json = nlohmann::json;

// Two configurations of the quick TestConverter, and the plugin path that finds it.
class Compare : public ::testing::Test {
 protected:
  Compare() {
    WriteText(low_, "<ConverterConfig type=\"TestConverter\"/>");
    WriteText(high_,
              "<ConverterConfig type=\"TestConverter\"><Test heightOffset_mm=\"200\"/>"
              "</ConverterConfig>");
  }

  static ProgramRun Run(const std::vector<std::string>& arguments) {
    std::vector<std::string> all = {"compare"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const std::string plugin = testing::TestPlugin("test_converter");
    return testing::RunProgram(
        all, {{"MMM_CONVERTER_PLUGIN_PATH", std::filesystem::path(plugin).parent_path().string()}});
  }

  Json RunForJson(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"-c", low_, "-c", high_, "--json", json_});
    const ProgramRun run = Run(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return Json::parse(ReadText(json_));
  }

  const std::string folder_ = TestFolder();
  const std::string low_ = folder_ + "/low.xml";
  const std::string high_ = folder_ + "/high.xml";
  const std::string json_ = folder_ + "/figures.json";
  const std::string truth_ = testing::SourcePath("examples/handstand_true.xml");
};

TEST_F(Compare, PrintsATableOfEveryRecordingAndConfiguration) {
  const ProgramRun run =
      Run({Handstand(), "--height", "1.8", "--frames", ":20", "-c", low_, "-c", high_});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("handstand.c3d: 20 frames at 100 Hz; 53 markers and 44 joints"));
  EXPECT_THAT(run.out, HasSubstr("\n  low "));
  EXPECT_THAT(run.out, HasSubstr("\n  high "));
  EXPECT_THAT(run.out, Not(HasSubstr("hid. mean")));
  EXPECT_EQ(run.err, "");
}

TEST_F(Compare, JsonHasAllFigures) {
  const Json figures = RunForJson({Handstand(), "--truth", truth_, "--frames", ":20", "--hide",
                                   "0.3", "--hide-model", "stationary", "--repeat", "3"});
  EXPECT_EQ(figures["options"]["hiding_model"], "stationary");
  EXPECT_EQ(figures["options"]["runs"], 3);
  EXPECT_EQ(figures["trials"][0]["name"], "handstand.c3d");
  EXPECT_EQ(figures["trials"][0]["compared_markers"], 53);
  EXPECT_TRUE(figures["trials"][0]["has_truth"]);
  EXPECT_NEAR(figures["trials"][0]["optimum_mm"], 38, 2);
  ASSERT_EQ(figures["rows"].size(), 2);
  const Json& low = figures["rows"][0];
  EXPECT_EQ(low["contender"], "low");
  EXPECT_TRUE(low["failure"].is_null());
  EXPECT_EQ(low["runs"].size(), 3);
  for (const char* key : {"mean", "p95", "max", "worst_frame"}) {
    EXPECT_GT(low["distance_mm"][key], 0) << key;
    EXPECT_GT(low["hidden_distance_mm"][key], 0) << key;
  }
  for (const char* key : {"frames_lost", "jitter_rad_per_s2", "largest_step_rad", "limit_share",
                          "joint_center_error_mm", "joint_angle_error_deg", "within_2_sd"}) {
    EXPECT_TRUE(low[key].is_number()) << key;
  }
  EXPECT_GT(low["ms_per_frame"]["p99"], 0);
  // 200 mm higher: nearly that much farther from every marker.
  EXPECT_GT(figures["rows"][1]["joint_center_error_mm"], low["joint_center_error_mm"]);
}

// Times differ from run to run.
void RemoveTimes(Json* figures) {
  (*figures)["options"].erase("jobs");
  for (Json& row : (*figures)["rows"]) {
    row.erase("ms_per_frame");
    for (Json& run : row["runs"]) run.erase("ms_per_frame");
  }
}

TEST_F(Compare, OnlyTimesDependOnTheNumberOfJobs) {
  const std::vector<std::string> arguments = {Handstand(), "--height", "1.8",  "--frames",
                                              ":30",       "--hide",   "0.05", "--repeat",
                                              "6",         "--seed",   "7",    "--jobs"};
  std::vector<Json> results;
  for (const char* jobs : {"1", "2", "5"}) {
    std::vector<std::string> with_jobs = arguments;
    with_jobs.emplace_back(jobs);
    results.push_back(RunForJson(with_jobs));
    RemoveTimes(&results.back());
  }
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

TEST_F(Compare, CsvHasALineForEachPair) {
  const std::string csv = folder_ + "/figures.csv";
  const ProgramRun run = Run({Handstand(), "--height", "1.8", "--frames", ":10", "-c", low_, "-c",
                              high_, "-c", "absent,\"one\"", "--csv", csv});
  EXPECT_EQ(run.exit_code, 1);
  std::istringstream lines(ReadText(csv));
  std::string heading;
  std::string line;
  std::getline(lines, heading);
  EXPECT_THAT(heading, HasSubstr("recording,configuration,failure,optimum_mm,mean_mm,p95_mm"));
  const auto columns = std::count(heading.begin(), heading.end(), ',');
  int pairs = 0;
  for (; pairs < 2; ++pairs) {
    ASSERT_TRUE(std::getline(lines, line));
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), columns);
  }
  ASSERT_TRUE(std::getline(lines, line));
  EXPECT_THAT(line, HasSubstr("\"absent,\"\"one\"\"\""));
}

TEST_F(Compare, WhatFailsIsARowWithItsReason) {
  const ProgramRun run = Run({Handstand(), folder_ + "/absent.c3d", "--height", "1.8", "--frames",
                              ":10", "-c", low_, "-c", "nosuch", "--json", json_});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.out, HasSubstr("\n  low "));
  EXPECT_THAT(run.out, HasSubstr("failed: nosuch on handstand.c3d: nosuch: no such file"));
  EXPECT_THAT(run.out, HasSubstr("failed: low on absent.c3d: " + folder_ + "/absent.c3d: no such"));
  const Json figures = Json::parse(ReadText(json_));
  ASSERT_EQ(figures["rows"].size(), 4);
  EXPECT_TRUE(figures["rows"][0]["failure"].is_null());
  EXPECT_THAT(figures["rows"][1]["failure"], HasSubstr("no such file"));
  EXPECT_FALSE(figures["rows"][1].contains("distance_mm"));
}

TEST_F(Compare, APluginThatIsNotThereFailsAlone) {
  const std::string config = folder_ + "/other.xml";
  WriteText(config, "<ConverterConfig type=\"OtherConverter\"/>");
  const ProgramRun run =
      Run({Handstand(), "--height", "1.8", "--frames", ":10", "-c", low_, "-c", config});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.out, HasSubstr("failed: other on handstand.c3d: there is no converter"));
  EXPECT_THAT(run.out, HasSubstr("\n  low "));
}

TEST_F(Compare, OptionsMayBeGivenForEachRecording) {
  const std::string copy = folder_ + "/again.c3d";
  std::filesystem::copy_file(Handstand(), copy);
  const Json figures = RunForJson({Handstand(), copy, "--truth", truth_, "--truth", "-", "--height",
                                   "1.8", "--height", "1.6", "--frames", ":10"});
  EXPECT_TRUE(figures["trials"][0]["has_truth"]);
  EXPECT_FALSE(figures["trials"][1]["has_truth"]);
  EXPECT_LT(figures["trials"][0]["optimum_mm"], figures["trials"][1]["optimum_mm"]);
}

TEST_F(Compare, SeveralRecordingsEndWithTheirMeans) {
  const std::string copy = folder_ + "/again.c3d";
  std::filesystem::copy_file(Handstand(), copy);
  const std::vector<std::string> one = {Handstand(), "--height", "1.8", "--frames",
                                        ":10",       "-c",       low_};
  std::vector<std::string> two = one;
  two.insert(two.begin() + 1, copy);
  EXPECT_THAT(Run(one).out, Not(HasSubstr("All")));
  EXPECT_THAT(Run(two).out, HasSubstr("All 2 recordings, each counting the same"));
}

TEST_F(Compare, TruthOfAnotherRateIsRefused) {
  const ProgramRun run = Run({Handstand(), "--truth", truth_, "--rate", "50", "-c", low_});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.out, HasSubstr("has 100 frames a second, the recording 50"));
}

TEST_F(Compare, TheGnuplotScriptDrawsFigures) {
  if (std::system("gnuplot --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "no gnuplot";
  const std::string script = folder_ + "/distance \"x\".gp";
  const ProgramRun run = Run({Handstand(), "--height", "1.8", "--frames", ":40", "--hide", "0.1",
                              "--repeat", "3", "-c", low_, "-c", high_, "--gnuplot", script});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(std::system(("cd '" + folder_ + "' && gnuplot '" + script + "'").c_str()), 0);
  EXPECT_THAT(ReadText(folder_ + "/distance \"x\"-1.svg"), HasSubstr("<svg"));
  EXPECT_THAT(ReadText(folder_ + "/distance \"x\"-1.svg"), HasSubstr("optimum"));
}

}  // namespace
}  // namespace mmm_converter
