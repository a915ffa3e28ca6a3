// SPDX-License-Identifier: MIT
// Every command with a model of OpenSim, by the example's model and recordings.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "common/convert/marker_set.h"
#include "common/io/model_file.h"
#include "common/io/osim/osim_model_reader.h"
#include "tests/cli/program.h"
#include "tests/support/osim_texts.h"
#include "tests/support/shared_data.h"
#include "tests/support/strict_tables.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using testing::ReadStrictMot;
using testing::ReadText;
using testing::RunProgram;
using testing::StrictTable;
using testing::TestFolder;
using testing::WriteText;
using Json = nlohmann::json;

std::string ExampleFile(const std::string& name) {
  return testing::SourcePath("examples/opensim/" + name);
}

std::string OutFile(const std::string& name) { return TestFolder() + "/" + name; }

void ExpectSuccess(const std::vector<std::string>& arguments) {
  const auto run = RunProgram(arguments);
  ASSERT_EQ(run.exit_code, 0) << run.err;
}

std::string ScaleExample() {
  ExpectSuccess({"calibrate", ExampleFile("static.trc"), "--model", ExampleFile("generic.osim"),
                 "--scale-setup", ExampleFile("scale_setup.xml"), "-o", OutFile("person.osim")});
  return OutFile("person.osim");
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

/// A set-up beside copies of the example's model and recording, as people send them.
std::string IkSetup() {
  for (const char* name : {"generic.osim", "walk.trc"}) {
    std::filesystem::copy_file(ExampleFile(name), OutFile(name),
                               std::filesystem::copy_options::overwrite_existing);
  }
  std::string tasks;
  for (const MarkerPair& pair :
       OwnMarkerSet(ReadModelFile(ExampleFile("generic.osim"), nullptr).model).pairs) {
    tasks += "<IKMarkerTask name='" + pair.target + "'><weight>" +
             (pair.target.starts_with("R") ? "10" : "1") + "</weight></IKMarkerTask>";
  }
  WriteText(OutFile("walk_Setup_IK.xml"),
            "<OpenSimDocument Version='40000'><InverseKinematicsTool>"
            "<model_file>C:\\Users\\anna\\generic.osim</model_file><IKTaskSet><objects>" +
                tasks +
                "</objects></IKTaskSet><marker_file>.\\walk.trc</marker_file>"
                "<time_range>0.1 0.3</time_range></InverseKinematicsTool></OpenSimDocument>");
  return OutFile("walk_Setup_IK.xml");
}

TEST(OsimCommands, ASetUpNamesRecordingModelWeightsAndTimes) {
  const std::string setup = IkSetup();
  const auto run = RunProgram({"convert", "--setup", setup, "-o", OutFile("setup.mot")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("names the model C:\\Users\\anna\\generic.osim"));
  const StrictTable by_setup = ReadStrictMot(ReadText(OutFile("setup.mot")));
  EXPECT_NEAR(by_setup.At(0, "time"), 0.1, 0.006);
  EXPECT_NEAR(by_setup.At(static_cast<int>(by_setup.rows.size()) - 1, "time"), 0.3, 0.006);
  // The same by options, the set-up's tasks being a marker set.
  const auto first = static_cast<int>(std::lround(by_setup.At(0, "time") * 100));
  const std::string frames =
      std::to_string(first) + ":" + std::to_string(first + static_cast<int>(by_setup.rows.size()));
  ExpectSuccess({"convert", OutFile("walk.trc"), "--model", OutFile("generic.osim"), "--marker-set",
                 setup, "--frames", frames, "-o", OutFile("options.mot")});
  EXPECT_EQ(ReadStrictMot(ReadText(OutFile("options.mot"))).rows, by_setup.rows);
  // Options go before it, and without weights the log names them.
  const auto whole = RunProgram({"convert", OutFile("walk.trc"), "--model", OutFile("generic.osim"),
                                 "--frames", "0:5", "-o", OutFile("whole.mot")});
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  EXPECT_THAT(whole.err, HasSubstr("walk_Setup_IK.xml has the weights"));
  ExpectSuccess({"convert", "--setup", setup, "--frames", "0:5", "-o", OutFile("short.mot")});
  EXPECT_EQ(ReadStrictMot(ReadText(OutFile("short.mot"))).rows.size(), 5U);
  EXPECT_THAT(RunProgram({"info", OutFile("generic.osim")}).out,
              HasSubstr("walk_Setup_IK.xml, for --marker-set"));
  EXPECT_THAT(RunProgram({"info", setup}).out,
              AllOf(HasSubstr("set-up of OpenSim's InverseKinematicsTool"), HasSubstr("walk.trc")));
}

TEST(OsimCommands, ASetUpIsNeverOverwrittenAndNamesWhatIsMissing) {
  const std::string setup = IkSetup(), before = ReadText(setup);
  const auto over = RunProgram({"convert", "--setup", setup, "-o", setup});
  EXPECT_NE(over.exit_code, 0);
  EXPECT_EQ(ReadText(setup), before);
  std::filesystem::remove(OutFile("walk.trc"));
  EXPECT_THAT(RunProgram({"convert", "--setup", setup}).err,
              HasSubstr("names the recording .\\walk.trc, which is neither there nor beside"));
  WriteText(setup,
            "<OpenSimDocument Version='40000'><InverseDynamicsTool><coordinates_file>a.mot"
            "</coordinates_file></InverseDynamicsTool></OpenSimDocument>");
  EXPECT_THAT(RunProgram({"convert", "--setup", setup}).err,
              HasSubstr("names no recording of markers, but the motion a.mot"));
}

TEST(OsimCommands, ThePersonIsScaledAndItsWalkIsFound) {
  const auto run =
      RunProgram({"calibrate", ExampleFile("static.trc"), "--model", ExampleFile("generic.osim"),
                  "--scale-setup", ExampleFile("scale_setup.xml"), "-o", OutFile("person.osim")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("68.000 kg"), HasSubstr("25 moved"),
                             HasSubstr("Scaled 8 bodies by 41 frames: wrote ")));
  const auto walk =
      RunProgram({"convert", ExampleFile("walk.trc"), "--model", OutFile("person.osim"), "-c",
                  "s2kf_offline", "-o", OutFile("walk.mot"), "--report", OutFile("walk.html")});
  ASSERT_EQ(walk.exit_code, 0) << walk.err;
  const StrictTable truth = ReadStrictMot(ReadText(ExampleFile("walk_true.mot")));
  const double error = AngleError(ReadStrictMot(ReadText(OutFile("walk.mot"))), truth);
  // Markers 6 mm off on lengths of 0.1 to 0.3 m, of which scaling knows some: 1 to 3 degrees.
  EXPECT_LT(error, 2.5);
  EXPECT_THAT(ReadText(OutFile("walk.html")), HasSubstr("knee_angle_r"));
  EXPECT_THAT(walk.out, AllOf(HasSubstr("(OpenSim, \"walk\")"), HasSubstr("verdict    good")));
  ExpectSuccess({"convert", ExampleFile("walk.trc"), "--model", ExampleFile("generic.osim"), "-c",
                 "s2kf_offline", "-o", OutFile("generic.mot")});
  EXPECT_LT(error, 0.85 * AngleError(ReadStrictMot(ReadText(OutFile("generic.mot"))), truth));
}

TEST(OsimCommands, AScaledModelIsReadAgain) {
  const std::string text = ReadText(ScaleExample());
  const KinematicModel model = ParseOsimModel(text, "person.osim");
  EXPECT_NEAR(model.total_mass(), 68, 1e-9);
  EXPECT_THAT(text, HasSubstr("<!-- A made model of trunk and legs, with round numbers. -->"));
  EXPECT_THAT(text, HasSubstr("<max_isometric_force>1169</max_isometric_force>"));
}

TEST(OsimCommands, ThePersonIsCalibratedByRecordings) {
  const std::string generic = ExampleFile("generic.osim");
  std::vector<std::string> words = {"calibrate",
                                    ExampleFile("static.trc"),
                                    ExampleFile("walk.trc"),
                                    "--model",
                                    generic,
                                    "--mass",
                                    "70.5",
                                    "-o",
                                    OutFile("person.osim")};
  const auto run = RunProgram(words);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("femur_r "), HasSubstr(" +- "), HasSubstr("70.500 kg"),
                             HasSubstr("25 moved"), ContainsRegex("walk.trc: [1-9][0-9]* of ")));
  const std::string text = ReadText(OutFile("person.osim"));
  EXPECT_NEAR(ParseOsimModel(text, "person.osim").total_mass(), 70.5, 1e-9);
  EXPECT_THAT(text, HasSubstr("<!-- A made model of trunk and legs, with round numbers. -->"));
  EXPECT_THAT(text, HasSubstr("<max_isometric_force>1169</max_isometric_force>"));
  words.back() = OutFile("again.osim");
  ExpectSuccess(words);
  EXPECT_EQ(ReadText(OutFile("again.osim")), text);

  const auto standing =
      RunProgram({"calibrate", ExampleFile("static.trc"), "--model", generic, "-o",
                  OutFile("standing.osim"), "--summary", OutFile("standing.json"), "--report",
                  OutFile("standing.html"), "--name", "A--na"});
  ASSERT_EQ(standing.exit_code, 0) << standing.err;
  EXPECT_THAT(ReadText(OutFile("standing.html")), HasSubstr("<h1>Calibration of A--na</h1>"));
  EXPECT_THAT(standing.out, HasSubstr("verdict    check"));
  const Json summary = Json::parse(ReadText(OutFile("standing.json")));
  EXPECT_THAT(summary["verdict"]["reasons"].dump(), HasSubstr("the person only stands"));
  EXPECT_EQ(summary["subject"]["name"], "A--na");
  const Json& deviations = summary["factor_deviations"]["femur_r"];
  EXPECT_LT(deviations[1], deviations[0]);  // nothing shows the thickness of a thigh
  EXPECT_THAT(standing.err, HasSubstr("the person only stands"));

  const StrictTable truth = ReadStrictMot(ReadText(ExampleFile("walk_true.mot")));
  double of_hip = 0;  // its deviation in the middle of the walk [deg]
  const auto error = [&](const std::string& model) {
    ExpectSuccess({"convert", ExampleFile("walk.trc"), "--model", model, "-c", "s2kf_offline", "-o",
                   OutFile("walk.mot")});
    of_hip = ReadStrictMot(ReadText(OutFile("walk_deviations.sto"))).At(80, "hip_flexion_r");
    return AngleError(ReadStrictMot(ReadText(OutFile("walk.mot"))), truth);
  };
  const double calibrated = error(OutFile("person.osim"));
  const double by_movement = of_hip;
  const double by_standing = error(OutFile("standing.osim"));
  // What standing does not tell is in the deviations of every motion that the model moves by.
  EXPECT_GT(of_hip, 1.3 * by_movement);
  EXPECT_GT(of_hip, 2);
  const double uncalibrated = error(generic);
  std::printf("[ measured ] %.2f deg rms, by standing %.2f, before %.2f\n", calibrated, by_standing,
              uncalibrated);
  EXPECT_LT(calibrated, 0.85 * uncalibrated);
  EXPECT_LT(by_standing, uncalibrated);
}

TEST(OsimCommands, CalibrationsAreMisused) {
  const auto refusal = [](std::vector<std::string> words, int code) {
    words.insert(words.begin(), "calibrate");
    words.insert(words.end(), {"--model", ExampleFile("generic.osim"), "-o", OutFile("none.osim")});
    const auto run = RunProgram(words);
    EXPECT_EQ(run.exit_code, code) << run.err;
    EXPECT_FALSE(std::filesystem::exists(OutFile("none.osim")));
    return run.err;
  };
  EXPECT_THAT(refusal({ExampleFile("walk.trc"), "--model-out", OutFile("s.xml")}, 2),
              HasSubstr("--model-out"));
  EXPECT_THAT(refusal({ExampleFile("walk.trc"), "--mass", "0"}, 2), HasSubstr("mass"));
}

TEST(OsimCommands, ScaleSetupsAreMisused) {
  const auto refusal = [](std::vector<std::string> more, int code) {
    std::vector<std::string> words = {
        "calibrate", ExampleFile("static.trc"), "--scale-setup", ExampleFile("scale_setup.xml"),
        "-o",        OutFile("none.osim")};
    words.insert(words.end(), more.begin(), more.end());
    const auto run = RunProgram(words);
    EXPECT_EQ(run.exit_code, code) << run.err;
    EXPECT_FALSE(std::filesystem::exists(OutFile("none.osim")));
    return run.err;
  };
  EXPECT_THAT(refusal({}, 1), HasSubstr("is no model of OpenSim"));
  const std::string model = ExampleFile("generic.osim");
  EXPECT_THAT(refusal({"--model", model, "--report", OutFile("s.html")}, 2), HasSubstr("--report"));
  EXPECT_THAT(refusal({ExampleFile("walk.trc"), "--model", model}, 2), HasSubstr("one recording"));
  EXPECT_THAT(refusal({"--model", model, "--marker-file", ExampleFile("scale_setup.xml")}, 1),
              HasSubstr("MarkerSet"));
}

// What a motion makes of a model's markers moves the same model as before, and another by what both
// have.
TEST(OsimCommands, AMotionMovesAnotherBody) {
  const std::string generic = ExampleFile("generic.osim");
  const std::vector<std::string> first = {"convert", ExampleFile("walk.trc"), "--model", generic,
                                          "-c",      "jacobian_opensim"};
  const auto convert = [](std::vector<std::string> words, const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
    ExpectSuccess(words);
  };
  convert(first, {"-o", OutFile("a.mot"), "--export-model-markers", OutFile("body.trc")});
  convert({"convert", OutFile("body.trc"), "--model", generic, "-c", "jacobian_opensim"},
          {"-o", OutFile("b.mot")});
  const StrictTable one = ReadStrictMot(ReadText(OutFile("a.mot")));
  // Places have 5 digits behind the millimetre's point.
  EXPECT_LT(AngleError(ReadStrictMot(ReadText(OutFile("b.mot"))), one), 0.02);

  convert({"convert", OutFile("body.trc"), "-c", "s2kf_offline"},
          {"-o", OutFile("mmm.xml"), "--export-model-markers", OutFile("mmm.trc"), "--summary",
           OutFile("mmm.json")});
  convert({"convert", OutFile("mmm.trc"), "--model", generic, "-c", "s2kf_offline"},
          {"-o", OutFile("c.mot"), "--summary", OutFile("back.json")});
  for (const char* summary : {"mmm.json", "back.json"}) {
    const Json json = Json::parse(ReadText(OutFile(summary)));
    const double distance = json.at("distance_mm").at("mean");
    // Bodies of other proportions, their landmarks some 20 mm apart.
    EXPECT_GT(distance, 5);
    EXPECT_LT(distance, 30);
  }
  const double error = AngleError(ReadStrictMot(ReadText(OutFile("c.mot"))), one);
  std::printf("[ measured ] there and back %.2f deg rms\n", error);
  EXPECT_LT(error, 11);
}

TEST(OsimCommands, CompareComparesPresets) {
  ExpectSuccess({"compare", ExampleFile("walk.trc"), "--model", ExampleFile("generic.osim"), "-c",
                 "s2kf_default", "-c", "jacobian_opensim", "--json", OutFile("c.json"), "--report",
                 OutFile("c.html")});
  const Json json = Json::parse(ReadText(OutFile("c.json")));
  EXPECT_THAT(json.dump(), AllOf(HasSubstr("s2kf_default"), HasSubstr("jacobian_opensim")));
  EXPECT_THAT(ReadText(OutFile("c.html")), HasSubstr("knee_angle_r"));
}

TEST(OsimCommands, BatchWritesCoordinatesAndResumes) {
  WriteText(OutFile("m.xml"), "<Batch model='" + ExampleFile("generic.osim") +
                                  "' config='s2kf_default'>" + "<Recording file='" +
                                  ExampleFile("walk.trc") + "' id='walk'/><Recording file='" +
                                  ExampleFile("static.trc") + "' id='static'/></Batch>");
  ExpectSuccess({"batch", OutFile("m.xml"), "-o", OutFile("out"), "--reports", "all"});
  ExpectSuccess({"convert", ExampleFile("walk.trc"), "--model", ExampleFile("generic.osim"), "-o",
                 OutFile("walk.mot")});
  EXPECT_EQ(ReadText(OutFile("out/motions/walk.mot")), ReadText(OutFile("walk.mot")));
  EXPECT_TRUE(std::filesystem::exists(OutFile("out/reports/static.html")));
  EXPECT_THAT(ReadText(OutFile("out/results.csv")), HasSubstr("motions/static.mot"));
  const auto again = RunProgram({"batch", OutFile("m.xml"), "-o", OutFile("out"), "--resume"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.out + again.err, HasSubstr("2 "));
}

TEST(OsimCommands, ALiveReplayGivesWhatAConversionGives) {
  for (const bool is_grounded : {false, true}) {
    std::string text = ReadText(ExampleFile("generic.osim"));
    const std::string tz = "<Coordinate name=\"pelvis_tz\">";
    if (is_grounded) text.insert(text.find(tz) + tz.size(), "<locked>true</locked>");
    WriteText(OutFile("m.osim"), text);
    const auto live = RunProgram({"live", "replay:" + ExampleFile("walk.trc") + "@max", "--model",
                                  OutFile("m.osim"), "-o", OutFile("live.mot")});
    ASSERT_EQ(live.exit_code, 0) << live.err;
    ExpectSuccess(
        {"convert", ExampleFile("walk.trc"), "--model", OutFile("m.osim"), "-o", OutFile("o.mot")});
    const StrictTable ours = ReadStrictMot(ReadText(OutFile("live.mot")));
    const StrictTable theirs = ReadStrictMot(ReadText(OutFile("o.mot")));
    ASSERT_EQ(ours.rows.size(), theirs.rows.size());
    ASSERT_EQ(ours.columns, theirs.columns);
    for (int k = 0; k < static_cast<int>(ours.rows.size()); ++k) {
      for (const std::string& name : ours.columns) {
        ASSERT_NEAR(ours.At(k, name), theirs.At(k, name), 1e-6) << name << " " << k;
      }
    }
  }
  const auto refused = RunProgram({"live", "replay:" + ExampleFile("walk.trc") + "@max", "--model",
                                   OutFile("m.osim"), "-o", OutFile("live.xml")});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("give the output the ending .mot"));
}

}  // namespace
}  // namespace mmm_converter
