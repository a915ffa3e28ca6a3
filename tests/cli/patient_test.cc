// SPDX-License-Identifier: MIT
// The page that a clinician prints: who it is of, and what strides are compared with.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/cli/program.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using testing::Handstand;
using ::testing::HasSubstr;
using testing::ReadText;
using testing::RunProgram;
using testing::SharedData;
using testing::TestFolder;
using testing::WriteText;
using Json = nlohmann::json;

// A data block of a page; null: there is none.
Json BlockOf(const std::string& file, const std::string& name) {
  const std::string page = ReadText(file);
  const std::string start = "class=\"" + name + "\">";
  const std::size_t begin = page.find(start);
  if (begin == std::string::npos) return nullptr;
  const std::size_t first = begin + start.size();
  return Json::parse(page.substr(first, page.find("</script>", first) - first));
}

Json GaitOf(const std::string& file) {
  return BlockOf(file, "tracks")["trials"][0]["ground"]["gait"];
}

TEST(Patient, PageSaysWhoAndHow) {
  const std::string page = TestFolder() + "/page.html";
  const auto run =
      RunProgram({"convert", Handstand(), "--height", "1.8", "-o", TestFolder() + "/o.xml",
                  "--report", page, "--subject-name", "Ann </script>", "--condition", "barefoot"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json patient = BlockOf(page, "patient");
  EXPECT_EQ(patient["name"], "Ann </script>");
  EXPECT_EQ(patient["height_m"]["value"], 1.8);
  EXPECT_EQ(patient["height_m"]["deviation"], nullptr);
  EXPECT_EQ(patient["mass_kg"]["source"], "assumed");
  ASSERT_EQ(patient["recordings"].size(), 1U);
  EXPECT_EQ(patient["recordings"][0]["condition"], "barefoot");
  EXPECT_EQ(patient["recordings"][0]["file"], "handstand.c3d");
  EXPECT_EQ(patient["recordings"][0]["verdict"], "check");
}

TEST(Patient, NormalBandsThatCannotBeReadEndItBeforeAnythingIsWritten) {
  const std::string norm = TestFolder() + "/norm.csv";
  WriteText(norm, "joint,angle,percent,mean,sd\nknee,flexion,0,a,1\n");
  const std::string out = TestFolder() + "/o.xml";
  const auto wrong = RunProgram({"convert", Handstand(), "-o", out, "--normal", norm});
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_THAT(wrong.err, HasSubstr("norm.csv:2: mean is \"a\"; give a number"));
  const auto missing = RunProgram({"convert", Handstand(), "-o", out, "--normal", norm + "x"});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.err, HasSubstr("norm.csvx"));
  EXPECT_FALSE(std::filesystem::exists(out));
  const auto same =
      RunProgram({"convert", Handstand(), "-o", out, "--normal", norm, "--report", norm});
  EXPECT_EQ(same.exit_code, 1);
  EXPECT_THAT(ReadText(norm), HasSubstr("knee"));
}

// The least and the largest knee flexion in the mean of a side's strides [degrees].
std::pair<double, double> KneeRange(const Json& gait, const std::string& side) {
  for (const Json& cycle : gait["cycles"]) {
    if (cycle["joint"] != "knee" || cycle["side"] != side || cycle["what"] != "flexion") continue;
    const auto mean = cycle["mean"].get<std::vector<double>>();
    const auto [least, most] = std::minmax_element(mean.begin(), mean.end());
    return {*least, *most};
  }
  return {0, 0};
}

// The page of examples, and what its command writes today, show what examples/
// make_gait_recording.cc made. Tolerances are what markers tell that are 8 mm off their places.
TEST(Patient, ExamplePageShowsTheGaitThatWasMade) {
  const std::string example = testing::SourcePath("examples/gait");
  const std::string page = TestFolder() + "/page.html";
  const auto run = RunProgram({"convert", example + ".c3d", "--height", "1.75", "--mass", "68",
                               "--self-calibrate", "-c", "s2kf_offline", "-o",
                               TestFolder() + "/o.xml", "--report", page});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const std::string& shown : {page, example + ".html"}) {
    SCOPED_TRACE(shown);
    const Json gait = GaitOf(shown);
    for (const bool is_left : {true, false}) {
      const std::string side = is_left ? "left" : "right";
      const Json& summary = gait["summary"][side];
      const auto mean = [&summary](const char* what) {
        return summary[what]["mean"].get<double>();
      };
      EXPECT_EQ(summary["step_length_m"]["strides"], 4);
      EXPECT_NEAR(mean("cadence_steps_per_min"), 120 / 1.06, 0.5);
      EXPECT_NEAR(mean("speed_m_per_s"), 1.26 / 1.06, 0.01);
      EXPECT_NEAR(mean("step_length_m"), is_left ? 0.66 : 0.60, 0.01);
      EXPECT_NEAR(mean("step_time_s"), (is_left ? 0.51 : 0.49) * 1.06, 0.01);
      EXPECT_NEAR(mean("foot_off_percent"), 61, 2);
      EXPECT_NEAR(mean("double_support_percent"), 22, 3);
      const auto [straight, bent] = KneeRange(gait, side);
      EXPECT_NEAR(straight, 4, 3) << side;
      EXPECT_NEAR(bent, is_left ? 62 : 53.7, 3) << side;
    }
  }
}

// The gait of a recording, compared with what it exports of itself: no difference is left.
TEST(PatientRealFiles, StridesAreScoredAgainstNormalBands) {
  const std::string walk = SharedData("field/btk_FunctionalWalk.c3d");
  if (!std::filesystem::exists(walk)) GTEST_SKIP() << "no " << walk;
  const std::string csv = TestFolder() + "/norm.csv", page = TestFolder() + "/page.html";
  const std::string out = TestFolder() + "/o.xml";
  const auto first =
      RunProgram({"convert", walk, "-o", out, "--export-gait", csv, "--report", page});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_FALSE(GaitOf(page).contains("profile"));
  std::string bands = "# Source: the same\n";
  for (const char* side : {"left", "right"}) {
    for (const char* end : {"0", "100"}) {
      bands += std::string(",foot,") + side + ",progression,degrees," + end + ",0,0,,2\n";
    }
  }
  WriteText(csv, ReadText(csv) + bands);
  const auto run = RunProgram({"convert", walk, "-o", out, "--normal", csv, "--report", page});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json gait = GaitOf(page);
  EXPECT_EQ(gait["normal"]["source"], "the same");
  for (const char* side : {"left", "right"}) {
    const Json& scores = gait["profile"][side]["variables"];
    ASSERT_EQ(scores.size(), 9U);
    for (const Json& one : scores) {
      EXPECT_EQ(one["strides"], 2);
      // Of two strides each is half as far from their mean as from the other.
      if (one["joint"] == "foot") continue;
      EXPECT_LT(one["mean"].get<double>(), 5) << one;
    }
    EXPECT_GT(scores.back()["mean"], 0);
  }
}

}  // namespace
}  // namespace mmm_converter
