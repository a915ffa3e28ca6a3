// SPDX-License-Identifier: MIT
// Every command with a model of OpenSim, by the example's model and recordings.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "common/io/osim/osim_model_reader.h"
#include "tests/cli/program.h"
#include "tests/support/osim_texts.h"
#include "tests/support/shared_data.h"
#include "tests/support/strict_tables.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::ReadStrictMot;
using testing::ReadText;
using testing::RunProgram;
using testing::StrictTable;
using testing::TestFolder;
using testing::WriteText;
using Json = nlohmann::json;

std::string Example(const std::string& name) {
  return testing::SourcePath("examples/opensim/" + name);
}

std::string Out(const std::string& name) { return TestFolder() + "/" + name; }

void ExpectSuccess(const std::vector<std::string>& arguments) {
  const auto run = RunProgram(arguments);
  ASSERT_EQ(run.exit_code, 0) << run.err;
}

std::string ScaledModel() {
  ExpectSuccess({"calibrate", Example("static.trc"), "--model", Example("generic.osim"),
                 "--scale-setup", Example("scale_setup.xml"), "-o", Out("person.osim")});
  return Out("person.osim");
}

/// Root mean square of the differences of all turns [deg], after the first tenth of a second.
double AngleError(const StrictTable& table, const StrictTable& truth) {
  EXPECT_EQ(table.columns, truth.columns);
  EXPECT_EQ(table.rows.size(), truth.rows.size());
  double squares = 0;
  int count = 0;
  for (const std::string& name : truth.columns) {
    if (name == "time" || name.starts_with("pelvis_t")) continue;
    for (int k = 10; k < static_cast<int>(truth.rows.size()); ++k) {
      const double error = table.At(k, name) - truth.At(k, name);
      squares += error * error;
      ++count;
    }
  }
  return std::sqrt(squares / count);
}

TEST(OsimCommands, ThePersonIsScaledAndItsWalkIsFound) {
  const auto run =
      RunProgram({"calibrate", Example("static.trc"), "--model", Example("generic.osim"),
                  "--scale-setup", Example("scale_setup.xml"), "-o", Out("person.osim")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("68.000 kg"), HasSubstr("25 moved"),
                             HasSubstr("Scaled 8 bodies by 41 frames: wrote ")));
  ExpectSuccess({"convert", Example("walk.trc"), "--model", Out("person.osim"), "-c",
                 "s2kf_offline", "-o", Out("walk.mot"), "--report", Out("walk.html")});
  const StrictTable truth = ReadStrictMot(ReadText(Example("walk_true.mot")));
  const double error = AngleError(ReadStrictMot(ReadText(Out("walk.mot"))), truth);
  // Markers 6 mm off on lengths of 0.1 to 0.3 m, of which scaling knows some: 1 to 3 degrees.
  EXPECT_LT(error, 2.5);
  EXPECT_THAT(ReadText(Out("walk.html")), HasSubstr("knee_angle_r"));
  ExpectSuccess({"convert", Example("walk.trc"), "--model", Example("generic.osim"), "-c",
                 "s2kf_offline", "-o", Out("generic.mot")});
  EXPECT_LT(error, 0.7 * AngleError(ReadStrictMot(ReadText(Out("generic.mot"))), truth));
}

TEST(OsimCommands, AScaledModelIsReadAgain) {
  const std::string text = ReadText(ScaledModel());
  const KinematicModel model = ParseOsimModel(text, "person.osim");
  EXPECT_NEAR(model.total_mass(), 68, 1e-9);
  EXPECT_THAT(text, HasSubstr("<!-- A made model of trunk and legs, with round numbers. -->"));
  EXPECT_THAT(text, HasSubstr("<max_isometric_force>1169</max_isometric_force>"));
}

TEST(OsimCommands, ScaleSetupsAreMisused) {
  const auto refusal = [](std::vector<std::string> more, int code) {
    std::vector<std::string> words = {
        "calibrate", Example("static.trc"), "--scale-setup", Example("scale_setup.xml"),
        "-o",        Out("none.osim")};
    words.insert(words.end(), more.begin(), more.end());
    const auto run = RunProgram(words);
    EXPECT_EQ(run.exit_code, code) << run.err;
    EXPECT_FALSE(std::filesystem::exists(Out("none.osim")));
    return run.err;
  };
  EXPECT_THAT(refusal({}, 1), HasSubstr("is no model of OpenSim"));
  const std::string model = Example("generic.osim");
  EXPECT_THAT(refusal({"--model", model, "--summary", Out("s.json")}, 2), HasSubstr("--summary"));
  EXPECT_THAT(refusal({Example("walk.trc"), "--model", model}, 2), HasSubstr("one recording"));
  EXPECT_THAT(refusal({"--model", model, "--marker-file", Example("scale_setup.xml")}, 1),
              HasSubstr("MarkerSet"));
}

TEST(OsimCommands, CompareComparesPresets) {
  ExpectSuccess({"compare", Example("walk.trc"), "--model", Example("generic.osim"), "-c",
                 "s2kf_default", "-c", "jacobian_opensim", "--json", Out("c.json"), "--report",
                 Out("c.html")});
  const Json json = Json::parse(ReadText(Out("c.json")));
  EXPECT_THAT(json.dump(), AllOf(HasSubstr("s2kf_default"), HasSubstr("jacobian_opensim")));
  EXPECT_THAT(ReadText(Out("c.html")), HasSubstr("knee_angle_r"));
}

TEST(OsimCommands, BatchWritesCoordinatesAndResumes) {
  WriteText(Out("m.xml"), "<Batch model='" + Example("generic.osim") + "' config='s2kf_default'>" +
                              "<Recording file='" + Example("walk.trc") +
                              "' id='walk'/><Recording file='" + Example("static.trc") +
                              "' id='static'/></Batch>");
  ExpectSuccess({"batch", Out("m.xml"), "-o", Out("out"), "--reports", "all"});
  ExpectSuccess(
      {"convert", Example("walk.trc"), "--model", Example("generic.osim"), "-o", Out("walk.mot")});
  EXPECT_EQ(ReadText(Out("out/motions/walk.mot")), ReadText(Out("walk.mot")));
  EXPECT_TRUE(std::filesystem::exists(Out("out/reports/static.html")));
  EXPECT_THAT(ReadText(Out("out/results.csv")), HasSubstr("motions/static.mot"));
  const auto again = RunProgram({"batch", Out("m.xml"), "-o", Out("out"), "--resume"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.out + again.err, HasSubstr("2 "));
}

TEST(OsimCommands, ALiveReplayGivesWhatAConversionGives) {
  for (const bool is_grounded : {false, true}) {
    std::string text = ReadText(Example("generic.osim"));
    const std::string tz = "<Coordinate name=\"pelvis_tz\">";
    if (is_grounded) text.insert(text.find(tz) + tz.size(), "<locked>true</locked>");
    WriteText(Out("m.osim"), text);
    const auto live = RunProgram({"live", "replay:" + Example("walk.trc") + "@max", "--model",
                                  Out("m.osim"), "-o", Out("live.mot")});
    ASSERT_EQ(live.exit_code, 0) << live.err;
    ExpectSuccess({"convert", Example("walk.trc"), "--model", Out("m.osim"), "-o", Out("o.mot")});
    const StrictTable ours = ReadStrictMot(ReadText(Out("live.mot")));
    const StrictTable theirs = ReadStrictMot(ReadText(Out("o.mot")));
    ASSERT_EQ(ours.rows.size(), theirs.rows.size());
    ASSERT_EQ(ours.columns, theirs.columns);
    for (int k = 0; k < static_cast<int>(ours.rows.size()); ++k) {
      for (const std::string& name : ours.columns) {
        ASSERT_NEAR(ours.At(k, name), theirs.At(k, name), 1e-6) << name << " " << k;
      }
    }
  }
  const auto refused = RunProgram({"live", "replay:" + Example("walk.trc") + "@max", "--model",
                                   Out("m.osim"), "-o", Out("live.xml")});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("give the output the ending .mot"));
}

}  // namespace
}  // namespace mmm_converter
