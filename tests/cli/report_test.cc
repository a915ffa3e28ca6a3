// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/cli/program.h"
#include "tests/support/shared_data.h"
#include "tests/support/test_plugins.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using testing::Handstand;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ReadText;
using testing::RunProgram;
using ::testing::StartsWith;
using testing::TestFolder;
using testing::WithTestConverter;
using Json = nlohmann::json;

// What the page looks like is tested in a browser (tests/report).
auto IsAPage() {
  return AllOf(StartsWith("<!DOCTYPE html>"), HasSubstr("</html>"), Not(HasSubstr("src=\"http")),
               Not(HasSubstr("href=\"http")));
}

TEST(Report, ConvertWritesAPageOfItsConversion) {
  const std::string page = TestFolder() + "/page.html";
  const auto run =
      RunProgram(WithTestConverter({"convert", Handstand(), "--height", "1.8", "--frames", ":20",
                                    "-o", TestFolder() + "/out.xml", "--report", page}));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(ReadText(page), IsAPage());
}

TEST(Report, ShowsFinishedMotions) {
  const std::string page = TestFolder() + "/page.html";
  const std::string json = TestFolder() + "/figures.json";
  const std::string truth = testing::SourcePath("examples/handstand_true.xml");
  const auto run = RunProgram({"report", Handstand(), truth, truth, "-o", page, "--json", json});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("handstand_true.xml (2)"));
  EXPECT_THAT(ReadText(page), IsAPage());
  const Json figures = Json::parse(ReadText(json));
  ASSERT_EQ(figures["rows"].size(), 2);
  // Marker offsets of 28 mm rms per axis are 28 sqrt(8/pi) = 44.7 mm on average; 53 markers.
  EXPECT_NEAR(figures["rows"][0]["distance_mm"]["mean"], 44.7, 5);
  EXPECT_TRUE(figures["rows"][0]["ms_per_frame"]["median"].is_null());
}

TEST(Report, GoesBesideTheRecording) {
  const std::string recording = TestFolder() + "/walk.c3d";
  std::filesystem::copy_file(Handstand(), recording);
  const auto run =
      RunProgram({"report", recording, testing::SourcePath("examples/handstand_true.xml")});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(std::filesystem::exists(TestFolder() + "/walk_report.html"));
}

TEST(ReportRealFiles, KitsOwnSolutionIsShownOnItsRecording) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::string file =
      testing::SharedData("mmm/kit_bimanual_10hz/Cut_files_motions_3021_Cut1_c_0_05cm_03.xml");
  const std::string json = TestFolder() + "/figures.json";
  const auto run = RunProgram({"report", file, file, "--motion", "true_1723", "-o",
                               TestFolder() + "/page.html", "--json", json});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  // KIT's joints include the fingers; its distances on this model are known from issue tests.
  EXPECT_NEAR(Json::parse(ReadText(json))["rows"][0]["distance_mm"]["mean"], 28.1, 0.2);
}

TEST(Report, MotionsThatDoNotBelongToTheRecordingAreRefused) {
  const std::string out = TestFolder() + "/page.html";
  const std::string truth = testing::SourcePath("examples/handstand_true.xml");
  auto run = RunProgram({"report", Handstand(), truth, "--rate", "120", "-o", out});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("has 100 frames a second, the recording 120"));
  const std::string part = TestFolder() + "/part.xml";
  run = RunProgram(WithTestConverter(
      {"convert", Handstand(), "--height", "1.8", "--frames", "10:20", "-o", part}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  run = RunProgram({"report", Handstand(), part, "-o", out});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("use --frames for the part that both have"));
  EXPECT_FALSE(std::filesystem::exists(out));
  run = RunProgram({"report", Handstand(), part, "--frames", "10:20", "-o", out});
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

TEST(Report, AMotionWithoutJointsIsRefused) {
  const std::string out = TestFolder() + "/page.html";
  const auto run = RunProgram({"report", Handstand(), testing::SourcePath("README.md"), "-o", out});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("README.md"));
}

}  // namespace
}  // namespace mmm_converter
