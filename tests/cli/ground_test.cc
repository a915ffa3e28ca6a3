// SPDX-License-Identifier: MIT
// Recordings of a made walker whose forces, lengths and events are known, with what files are known
// to hold wrong: the right number, or told.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "common/io/c3d/c3d_events.h"
#include "common/io/c3d/c3d_reader.h"
#include "common/support/units.h"
#include "tests/cli/program.h"
#include "tests/support/shared_data.h"
#include "tests/support/strict_tables.h"

namespace mmm_converter {
namespace {

using ::testing::AnyOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::ReadStrictMot;
using testing::ReadText;
using testing::RunProgram;
using testing::StrictTable;
using testing::TestFolder;

class RealGround : public ::testing::Test {
 protected:
  void SetUp() override { MMM_CONVERTER_NEEDS_SHARED_DATA(); }

  static std::string Out(const char* name) { return TestFolder() + "/" + name; }
  static std::string Recording(const std::string& name) {
    return testing::SharedData("reports/" + name);
  }

  struct Converted {
    std::string said;
    std::vector<std::string> reasons;  ///< of the verdict, but for the walker's ankles
  };

  static Converted Convert(const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"convert",    Recording(name), "-o",
                                          Out("o.xml"), "--summary",     Out("o.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto run = RunProgram(arguments);
    EXPECT_EQ(run.exit_code, 0) << name << ": " << run.err;
    Converted converted = {run.out + run.err, {}};
    const auto summary = nlohmann::json::parse(ReadText(Out("o.json")));
    for (const auto& one : summary["verdict"]["reasons"]) {
      const auto reason = one.get<std::string>();
      // The walker was made without the model: its ankles bend by 38 degrees, the model's by 30.
      const bool is_of_ankles = reason.find("at their limits") != reason.npos &&
                                reason.find("LAx_joint (6 %), RAx_joint (6 %);") != reason.npos;
      if (!is_of_ankles) converted.reasons.push_back(reason);
    }
    return converted;
  }

  /// In the middle of the left foot's stance, at 1.7 s, within 1 % of the weight and 10 mm.
  static void ExpectForces(const std::string& name) {
    constexpr double kForce = 0.01 * 686.7, kCentre = 0.01;
    const StrictTable grf = ReadStrictMot(ReadText(Out("grf.mot")));
    const auto row = static_cast<std::size_t>(std::lround((1.7 - grf.At(0, "time")) * 1000));
    const auto at = [&](const char* column) { return grf.At(row, column); };
    EXPECT_NEAR(at("ground_force_1_vx"), -15.129, kForce) << name;
    EXPECT_NEAR(at("ground_force_1_vy"), 686.7, kForce) << name;
    EXPECT_NEAR(at("ground_force_1_vz"), 27.468, kForce) << name;
    EXPECT_NEAR(at("ground_force_1_px"), 1.857, kCentre) << name;
    EXPECT_NEAR(at("ground_force_1_pz"), -0.091, kCentre) << name;
  }
};

TEST_F(RealGround, PlatesThatFilesDescribeWrongAreReadRightAndTold) {
  const std::pair<const char*, const char*> cases[] = {
      {"f_kilonewton.c3d", ""},
      {"f_corners_180.c3d", "corners in the order 3, 4, 1, 2"},
      {"f_type4_volts_nm.c3d", "moments in N m"},
      {"f_baseline.c3d", "N while nobody is on it"}};
  for (const auto& [name, told] : cases) {
    const Converted run = Convert(name, {"--export-grf", Out("grf.mot")});
    ExpectForces(name);
    if (*told == '\0') {
      EXPECT_THAT(run.said, Not(HasSubstr("force plate "))) << name;
    } else {
      EXPECT_THAT(run.said, HasSubstr(told)) << name;
    }
    EXPECT_THAT(run.reasons, IsEmpty()) << name;
  }
}

TEST_F(RealGround, PointsOfATableInMillimetres) {
  const Converted run = Convert(
      "f_none.c3d", {"--forces", Recording("g_points_in_mm.mot"), "--export-grf", Out("grf.mot")});
  EXPECT_THAT(run.said, HasSubstr("points in mm"));
  ExpectForces("g_points_in_mm.mot");
}

TEST_F(RealGround, ASaturatedPlateIsAReasonOfTheVerdict) {
  const Converted run = Convert("f_saturated_fz.c3d", {});
  EXPECT_THAT(run.said, HasSubstr("Fz is saturated"));
  EXPECT_THAT(run.said, HasSubstr("from 1.4"));
  EXPECT_THAT(run.reasons, ElementsAre(HasSubstr("force plate 1 is saturated from 1.4")));
}

TEST_F(RealGround, LoadsOfNoFootAreTold) {
  const Converted run = Convert(
      "f_treadmill_cross.c3d", {"--export-grf", Out("grf.mot"), "--export-gait", Out("gait.json")});
  EXPECT_FALSE(nlohmann::json::parse(ReadText(Out("gait.json")))["work"].empty());
  EXPECT_THAT(run.reasons, IsEmpty());
  EXPECT_THAT(run.said, HasSubstr("is applied to no foot"));
  EXPECT_THAT(run.said, HasSubstr("plate 2 from 1.94"));
  EXPECT_THAT(run.said, HasSubstr("plate 1 from 3.59"));
}

TEST_F(RealGround, StridesOfSeveralTrialsAreOneTableAndForceChannelsWithoutPlatesAreTold) {
  const char* const names[] = {"f_channels_without_group", "w_treadmill_2800ms"};
  std::vector<std::string> arguments = {"convert", "--export-gait", Out("gait.csv")};
  for (const char* name : names) {
    const std::string copy = TestFolder() + "/" + name + ".c3d";
    std::filesystem::copy_file(Recording(name + std::string(".c3d")), copy);
    arguments.push_back(copy);
  }
  const auto run = RunProgram(arguments);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("has force channels"));
  const std::string table = ReadText(Out("gait.csv"));
  EXPECT_THAT(table, HasSubstr("\nf_channels_without_group,knee,left,flexion,degrees,50,"));
  EXPECT_THAT(table, HasSubstr("\nw_treadmill_2800ms,knee,right,flexion,degrees,100,"));
}

TEST_F(RealGround, EventsOfTheFileCountWhereTheUserSaysSo) {
  const auto refused = RunProgram({"convert", Recording("f_base_type2.c3d"), "-o", Out("o.xml"),
                                   "--events", "file", "--export-contacts", Out("c.json")});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("has no events of feet"));
  // Its eleven events are of two strides of a longer walk.
  const std::string walk = testing::SharedData("field/btk_FunctionalWalk.c3d");
  const auto run = RunProgram({"convert", walk, "-o", Out("o.xml"), "--events", "file",
                               "--export-contacts", Out("c.json")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out + run.err, HasSubstr("are by the file's events"));
  const auto events = nlohmann::json::parse(ReadText(Out("c.json")))["events"];
  ASSERT_EQ(events.size(), 11);
  EXPECT_NEAR(events[0]["time_s"].get<double>(), 4.525, 1e-3);
}

void ExpectNear(const nlohmann::json& figure, double value, double share) {
  ASSERT_TRUE(figure["mean"].is_number());
  EXPECT_NEAR(figure["mean"].get<double>(), value, share * value);
}

/// The made walker, whose plates and strides are known.
TEST_F(RealGround, StridesAndSteps) {
  struct Walk {
    const char* file;
    double time, length, step;
    const char* kind;
    bool turns;
  };
  const Walk walks[] = {{"f_base_type2.c3d", 1.1, 1.2, 0.6, "walking", false},
                        {"w_turn180.c3d", 1.1, 1.2, 0.6, "walking", true},
                        {"w_running.c3d", 0.7, 2.3, 1.15, "running", false},
                        {"w_slow_stride_2800ms.c3d", 2.8, 0.5, 0.25, "walking", false},
                        {"w_treadmill_2800ms.c3d", 1.1, 1.2, 0.6, "walking", false}};
  for (const Walk& walk : walks) {
    SCOPED_TRACE(walk.file);
    const bool has_plates = &walk == &walks[0];
    std::vector<std::string> more = {"--height", "1.75", "--export-gait", Out("gait.json")};
    if (has_plates) more.insert(more.end(), {"--export-grf", Out("grf.mot")});
    const Converted run = Convert(walk.file, more);
    const auto gait = nlohmann::json::parse(ReadText(Out("gait.json")));
    for (const char* side : {"left", "right"}) {
      const auto& summary = gait["summary"][side];
      ExpectNear(summary["stride_time_s"], walk.time, 0.02);
      ExpectNear(summary["cadence_steps_per_min"], 120 / walk.time, 0.02);
      ExpectNear(summary["stride_length_m"], walk.length, 0.02);
      ExpectNear(summary["speed_m_per_s"], walk.length / walk.time, 0.02);
      ExpectNear(summary["step_length_m"], walk.step, 0.05);
    }
    EXPECT_EQ(gait["kind"], walk.kind);
    EXPECT_EQ(gait["strides_over_turns"].get<int>() > 0, walk.turns);
    EXPECT_EQ(run.said.find("over a turn") != std::string::npos, walk.turns);
    if (!has_plates) continue;
    ExpectForces(walk.file);
    EXPECT_THAT(run.said, Not(HasSubstr("force plate ")));
    EXPECT_THAT(run.reasons, IsEmpty());
    EXPECT_THAT(gait["forces"].dump(), HasSubstr("W/kg"));
  }
}

TEST_F(RealGround, MusclesStandBesideTheAnglesOverTheStrides) {
  const std::string walk = testing::SharedData("field/btk_FunctionalWalk.c3d");
  const auto run = RunProgram({"convert", walk, "-o", Out("o.xml"), "--emg", "emg3,EMG4",
                               "--export-gait", Out("gait.json")});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  int muscles = 0;
  const auto gait = nlohmann::json::parse(ReadText(Out("gait.json")));
  for (const auto& one : gait["forces"]) {
    if (one["what"] != "EMG") continue;
    EXPECT_EQ(one["unit"], "mV");
    EXPECT_THAT(one["joint"], AnyOf("EMG3", "EMG4"));
    EXPECT_GT(one["mean"][50], 0);
    ++muscles;
  }
  EXPECT_EQ(muscles, 4);  // each over the strides of either foot
  const auto refused = RunProgram({"convert", walk, "-o", Out("p.xml"), "--emg", "EMG99"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("has no analog channel EMG99; its analog channels are "));
  EXPECT_FALSE(std::filesystem::exists(Out("p.xml")));
}

// Results of a recording go back into a copy of it as points, and say what the tables say.
TEST_F(RealGround, ResultsGoBackIntoTheRecording) {
  Convert("f_baseline.c3d",
          {"--export-c3d", Out("walk.c3d"), "--export-angles", Out("angles.csv")});
  C3dReader reader(Out("walk.c3d"));
  const auto value = [&](const char* label, int frame) -> Eigen::Vector3d {
    const auto& labels = reader.info().labels;
    const auto found = std::find(labels.begin(), labels.end(), label);
    EXPECT_NE(found, labels.end()) << label;
    const C3dPoint point =
        reader.ReadFrame(frame)[static_cast<std::size_t>(found - labels.begin())];
    return point.valid ? point.position : Eigen::Vector3d::Constant(kNaN).eval();
  };
  constexpr int kFrame = 150;
  int compared = 0;
  const auto expect = [&](const std::string& row, const std::string& begin, const char* label,
                          int j) {
    if (!row.starts_with(begin)) return;
    EXPECT_NEAR(value(label, kFrame)[j], std::stod(row.substr(begin.size())), 1e-4) << row;
    ++compared;
  };
  std::istringstream rows(ReadText(Out("angles.csv")));
  for (std::string row; std::getline(rows, row);) {
    expect(row, "1.5,knee,left,flexion,", "LKneeAngles", 0);
    expect(row, "1.5,hip,right,adduction,", "RHipAngles", 1);
    expect(row, "1.5,pelvis,right,obliquity,", "RPelvisAngles", 1);
    expect(row, "1.5,ankle,left,dorsiflexion,", "LAnkleAngles", 0);
  }
  EXPECT_EQ(compared, 4);
  // In the middle of the left foot's stance its leg bears the person.
  EXPECT_TRUE(value("LAnkleMoment", 170).allFinite());
  EXPECT_TRUE(value("LKneePower", 170).allFinite());
  EXPECT_GE(ReadC3dEvents(C3dFile(Out("walk.c3d")), nullptr).size(), 4);
}

// One person's contacts are the same for all commands.
class OneGround : public ::testing::Test {
 protected:
  static std::string Out(const char* name) { return TestFolder() + "/one_ground_" + name; }

  static nlohmann::json Run(std::vector<std::string> words, const char* summary) {
    std::filesystem::remove(Out(summary));
    words.insert(words.end(), {"--summary", Out(summary)});
    const auto run = RunProgram(words);
    EXPECT_LE(run.exit_code, 1) << run.err;  // 1: a motion is implausible
    return nlohmann::json::parse(ReadText(Out(summary)), nullptr, false);
  }

  /// Each of `told`, where its leg was seen, is among `others` within a frame.
  static void ExpectAmong(const nlohmann::json& told, const nlohmann::json& others, double frame,
                          const char* where) {
    for (const nlohmann::json& one : told) {
      int found = 0;
      for (const nlohmann::json& other : others) {
        bool is_same = one["foot"] == other["foot"];
        for (const char* key : {"begin_s", "end_s"}) {
          if (one[key].is_null()) continue;
          is_same = is_same && other[key].is_number() &&
                    std::abs(other[key].get<double>() - one[key].get<double>()) <= frame;
        }
        found += is_same;
      }
      EXPECT_GE(found, 1) << where << ": " << one << " among " << others;
    }
  }

  static nlohmann::json StancesOfGait(const nlohmann::json& gait) {
    nlohmann::json stances = nlohmann::json::array();
    for (const nlohmann::json& stride : gait["strides"]) {
      const double begin = stride["begin_s"], end = stride["end_s"];
      nlohmann::json stance = {{"foot", stride["side"]}, {"begin_s", begin}, {"end_s", nullptr}};
      if (stride["foot_off_percent"].is_number()) {
        stance["end_s"] = begin + 0.01 * stride["foot_off_percent"].get<double>() * (end - begin);
      }
      stances.push_back(stance);
    }
    return stances;
  }

  /// frame: of check-dynamics, beside the forces that were exported [s]; 0: not asked.
  static void ExpectSameEverywhere(const std::string& recording, bool has_plates, double frame,
                                   std::size_t least) {
    std::vector<std::string> convert = {"convert",       recording,           "-o",
                                        Out("o.xml"),    "--export-contacts", Out("c.json"),
                                        "--export-gait", Out("g.json")};
    std::vector<std::string> check = {"check-dynamics", Out("o.xml")};
    if (has_plates) {
      convert.insert(convert.end(), {"--export-grf", Out("grf.mot")});
      check.insert(check.end(), {"--forces", Out("grf.xml")});
    }
    Run(convert, "o.json");
    const nlohmann::json contacts = nlohmann::json::parse(ReadText(Out("c.json")))["contacts"];
    ASSERT_GE(contacts.size(), least);
    const nlohmann::json strides = StancesOfGait(nlohmann::json::parse(ReadText(Out("g.json"))));
    ExpectAmong(strides, contacts, 1e-3, "gait");
    const nlohmann::json brought =
        Run({"retarget", recording, "--robot", testing::SourcePath("examples/robot/biped.urdf"),
             "-o", Out("r.xml")},
            "r.json");
    ExpectAmong(contacts, brought["stances"], 1e-3, "retarget");
    if (!(frame > 0)) return;
    const nlohmann::json checked = Run(check, "d.json");
    ExpectAmong(contacts, checked["stances"], frame, "check-dynamics");
  }
};

TEST_F(OneGround, OfTheSample) {
  ExpectSameEverywhere(testing::SourcePath("examples/handstand.c3d"), false, 0.01, 4);
}

using RealOneGround = OneGround;
TEST_F(RealOneGround, OfRecordings) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  struct Case {
    const char* file;
    std::size_t least;
    double frame;  ///< 0: the finished motion and a table of forces tell a little less
  };
  for (const Case& one :
       {Case{"field/btk_FunctionalWalk.c3d", 8, 1.0 / 120},
        Case{"reports/f_base_type2.c3d", 9, 0.01}, Case{"forces/walking2.c3d", 5, 0},
        Case{"recordings/whole_body/pycgm_movement_trial.c3d", 6, 0}}) {
    SCOPED_TRACE(one.file);
    ExpectSameEverywhere(testing::SharedData(one.file), true, one.frame, one.least);
  }
}

}  // namespace
}  // namespace mmm_converter
