// SPDX-License-Identifier: MIT
// What `convert` says of recordings that were made wrong, and of right ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "common/io/c3d/c3d_writer.h"
#include "common/io/recording/recording.h"
#include "common/math/seeded_random.h"
#include "common/support/units.h"
#include "tests/cli/program.h"
#include "tests/support/changed_markers.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using testing::Handstand;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ReadText;
using testing::RunProgram;
using testing::TestFolder;

struct Judged {
  std::string level;
  std::string reasons;
  nlohmann::json recording;  ///< what the summary says of it
};

std::string SubjectOutput() { return TestFolder() + "/subject.xml"; }

Judged Run(const std::string& command, const std::string& recording, const std::string& output,
           const std::vector<std::string>& options) {
  const std::string summary = TestFolder() + "/verdict.json";
  std::vector<std::string> arguments = {command, recording, "-o", output, "--summary", summary};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const auto run = RunProgram(arguments);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto json = nlohmann::json::parse(ReadText(summary));
  const std::string level = json["verdict"]["level"];
  std::string reasons;
  for (const std::string reason : json["verdict"]["reasons"]) reasons += reason + "; ";
  EXPECT_THAT(run.out, HasSubstr("verdict    " + level));
  EXPECT_EQ(level == "good", reasons.empty()) << reasons;
  return {level, reasons, json.value("input", nlohmann::json())};
}

Judged Convert(const std::string& recording, const std::vector<std::string>& options) {
  return Run("convert", recording, TestFolder() + "/verdict.xml", options);
}

// The sample from standing into the handstand.
const MarkerSequence& Sample() {
  static const MarkerSequence kMarkers = ReadRecording(Handstand(), {}).markers.Slice(50, 250);
  return kMarkers;
}

Judged ConvertMarkers(const MarkerSequence& markers,
                      const std::vector<std::string>& options = {"--height", "1.8"}) {
  const std::string file = TestFolder() + "/made.c3d";
  WriteC3d(file, markers);  // states that z is up
  return Convert(file, options);
}

Judged CalibrateOn(const MarkerSequence& markers) {
  const std::string file = TestFolder() + "/calibration.c3d";
  WriteC3d(file, markers);
  return Run("calibrate", file, SubjectOutput(), {"--height", "1.8"});
}

using Point = Eigen::Ref<Eigen::Vector3d>;

// The sample with each seen position changed: change(frame, label, position).
MarkerSequence Changed(const std::function<void(int, int, Point)>& change) {
  MarkerSequence markers = Sample();
  for (int k = 0; k < markers.num_frames(); ++k) {
    auto frame = markers.frame(k);
    for (int i = 0; i < markers.num_labels(); ++i) change(k, i, frame.col(i));
  }
  return markers;
}

// The sample with other labels on its markers.
MarkerSequence Relabelled(const std::vector<std::string>& labels) {
  const MarkerSequence& sample = Sample();
  MarkerSequence markers(labels, sample.num_frames(), sample.rate(), 0);
  for (int k = 0; k < sample.num_frames(); ++k) markers.frame(k) = sample.frame(k);
  return markers;
}

bool IsOfLeg(const std::string& label) {
  static const std::vector<std::string> kOfLegs = {"HEE", "TOE", "MT1", "MT5", "ANK",
                                                   "KNE", "THI", "TIP", "HIP"};
  return std::any_of(kOfLegs.begin(), kOfLegs.end(),
                     [&](const std::string& name) { return label.substr(1) == name; });
}

std::vector<std::string> WithSidesExchanged(const std::function<bool(const std::string&)>& is_it) {
  std::vector<std::string> labels = Sample().labels();
  const std::vector<std::string> before = labels;
  for (std::string& label : labels) {
    std::string other = label;
    other[0] = label[0] == 'L' ? 'R' : label[0] == 'R' ? 'L' : label[0];
    const bool is_there = std::count(before.begin(), before.end(), other) > 0;
    if (is_there && is_it(label)) label = other;
  }
  return labels;
}

// Only those labels.
MarkerSequence Only(const std::function<bool(const std::string&)>& is_it) {
  const MarkerSequence& sample = Sample();
  std::vector<int> columns;
  std::vector<std::string> labels;
  for (int i = 0; i < sample.num_labels(); ++i) {
    if (!is_it(sample.labels()[i])) continue;
    columns.push_back(i);
    labels.push_back(sample.labels()[i]);
  }
  MarkerSequence markers(labels, sample.num_frames(), sample.rate(), 0);
  for (int k = 0; k < sample.num_frames(); ++k) {
    markers.frame(k) = sample.frame(k)(Eigen::all, columns);
  }
  return markers;
}

/// Where reference markers are not where they are worn, feet are not either.
bool OnlyLimitsAreTold(const Judged& judged) {
  return judged.level == "check" && judged.reasons.starts_with("joints stand at their limits") &&
         judged.reasons.ends_with("Calibrating the person finds where they are worn.; ");
}

TEST(Verdict, TheSampleIsGoodWhereItsPersonIsCalibrated) {
  EXPECT_TRUE(OnlyLimitsAreTold(Convert(Handstand(), {"--height", "1.8"})));
  EXPECT_TRUE(OnlyLimitsAreTold(Convert(Handstand(), {})));
  EXPECT_EQ(Convert(Handstand(), {"--height", "1.8", "--self-calibrate"}).level, "good");
}

TEST(Verdict, AFileThatIsCutIsToBeLookedAt) {
  const std::string cut = TestFolder() + "/cut.c3d";
  const std::string whole = testing::ReadText(Handstand());
  testing::WriteText(cut, whole.substr(0, whole.size() / 2));
  const Judged judged = Convert(cut, {"--height", "1.8"});
  EXPECT_EQ(judged.level, "check");
  EXPECT_THAT(judged.reasons, HasSubstr("cut off: it declares 675 frames"));
}

TEST(Verdict, OfACalibration) {
  EXPECT_EQ(CalibrateOn(Sample()).level, "good");
  const MarkerSequence exchanged = Relabelled(WithSidesExchanged(IsOfLeg));
  Judged judged = CalibrateOn(exchanged);
  EXPECT_EQ(judged.level, "failed");
  EXPECT_THAT(judged.reasons, HasSubstr("left and right labels of the legs are exchanged"));
  judged = CalibrateOn(Relabelled(WithSidesExchanged([](const std::string&) { return true; })));
  EXPECT_EQ(judged.level, "failed");
  EXPECT_THAT(judged.reasons, HasSubstr("left and right labels of all markers are exchanged"));
  // A person that was calibrated like that does not hide it.
  const std::string recording = TestFolder() + "/exchanged.c3d";
  WriteC3d(recording, exchanged);
  judged = Convert(recording, {"--subject-file", SubjectOutput()});
  EXPECT_EQ(judged.level, "failed");
  EXPECT_THAT(judged.reasons, HasSubstr("left and right labels of the legs are exchanged"));
}

TEST(Verdict, NoCalibrationOnOthersMarkers) {
  const MarkerSequence& sample = Sample();
  const std::string merged = TestFolder() + "/merged.c3d";
  WriteC3d(merged, Changed([&](int k, int i, Point p) {
             if (i % 7 != 0) return;
             p = sample.frame((k + 100) % sample.num_frames()).col(i);
             p += Eigen::Vector3d(1, 0.5, 0);
           }));
  const auto run = RunProgram({"calibrate", merged, "--height", "1.8", "-o", SubjectOutput()});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("are not of one person with these labels: 8 of 53 markers"));
}

TEST(VerdictRealFiles, RealRecordingsAreGoodWhereTheirPersonsAreCalibrated) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  for (const char* file : {"kit_bimanual_c3d/Close_1723.c3d", "kit_bimanual_c3d/Cut_1723.c3d",
                           "kit_bimanual_c3d/Peel_1723.c3d", "kit_bimanual_c3d/Pour_1480.c3d",
                           "kit_bimanual_c3d/Stir_1723.c3d", "synthetic/kit53_yup_screen_X_Y.c3d",
                           "synthetic/kit53_gaps_nan_residual0.c3d"}) {
    const std::string path = testing::SharedData(std::string("recordings/") + file);
    const Judged judged = Convert(path, {});
    EXPECT_TRUE(judged.level == "good" || OnlyLimitsAreTold(judged)) << file << judged.reasons;
    const Judged calibrated = Convert(path, {"--self-calibrate"});
    EXPECT_EQ(calibrated.level, "good") << file << ": " << calibrated.reasons;
  }
}

// Of sets whose places are those of landmarks, only legs that stand at their limits are told.
TEST(VerdictRealFiles, RealRecordingsOfOtherSetsAreGoodButForLimits) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  for (const char* file :
       {"trc/motek_T.trc", "whole_body/85_02.c3d", "whole_body/cmu_02_05.c3d",
        "whole_body/kinematics_tennis_serve.c3d", "whole_body/pycgm_movement_trial.c3d"}) {
    const Judged judged = Convert(testing::SharedData(std::string("recordings/") + file), {});
    if (judged.level == "good") continue;
    EXPECT_EQ(judged.level, "check") << file;
    EXPECT_TRUE(judged.reasons.starts_with("joints stand at their limits"))
        << file << ": " << judged.reasons;
  }
}

TEST(Verdict, AnAxisThatTheBodyContradictsIsToBeChecked) {
  // Turned by a quarter and a half turn about x, on which the file still says that z is up.
  const auto lie = [](int, int, Point p) { p = Eigen::Vector3d(p.x(), -p.z(), p.y()); };
  Judged judged = ConvertMarkers(Changed(lie));
  EXPECT_EQ(judged.level, "check");
  EXPECT_THAT(judged.reasons, HasSubstr("states that +z is up"));
  EXPECT_THAT(judged.reasons, HasSubstr("+z is taken (another by --up AXIS)"));
  const auto turn_over = [](int, int, Point p) { p = Eigen::Vector3d(p.x(), -p.y(), -p.z()); };
  judged = ConvertMarkers(Changed(turn_over));
  EXPECT_EQ(judged.recording["up_axis"], "-z") << judged.recording;
  EXPECT_EQ(judged.recording["up_axis_stated"], "+z");
  judged = ConvertMarkers(Sample(), {"--height", "1.8", "--up", "y"});
  EXPECT_EQ(judged.level, "check");
  EXPECT_THAT(judged.reasons, HasSubstr("given as up"));
}

TEST(Verdict, AHeightThatTheMarkersContradict) {
  for (const char* height : {"1.26", "1.53", "2.07", "2.34"}) {
    const Judged judged = ConvertMarkers(Sample(), {"--height", height});
    EXPECT_NE(judged.level, "good") << height;
    EXPECT_THAT(judged.reasons, HasSubstr(std::string("the height is ") + height)) << height;
  }
  // A calibration takes up what is wrong, so that no distance shows it.
  const Judged judged = Convert(Handstand(), {"--height", "2.34", "--self-calibrate"});
  EXPECT_EQ(judged.level, "failed");
  EXPECT_THAT(judged.reasons, HasSubstr("the markers are those of a person of 1.8"));
}

TEST(Verdict, ExchangedSides) {
  const auto any = [](const std::string&) { return true; };
  Judged judged = ConvertMarkers(Relabelled(WithSidesExchanged(any)));
  EXPECT_EQ(judged.level, "failed");
  EXPECT_THAT(judged.reasons, HasSubstr("labels of all markers are exchanged"));
  judged = ConvertMarkers(Changed([](int, int, Point p) { p.x() = -p.x(); }));
  EXPECT_EQ(judged.level, "failed");
  EXPECT_THAT(judged.reasons, HasSubstr("or coordinates mirrored"));
  judged = ConvertMarkers(Relabelled(WithSidesExchanged(IsOfLeg)));
  EXPECT_EQ(judged.level, "failed");
  EXPECT_THAT(judged.reasons, HasSubstr("labels of the legs are exchanged"));
}

// Outputs are written all the same.
TEST(Verdict, IsAnExitCodeWhereItIsAskedFor) {
  const std::string file = TestFolder() + "/made.c3d";
  const std::string motion = TestFolder() + "/strict.xml";
  WriteC3d(file, Relabelled(WithSidesExchanged([](const std::string&) { return true; })));
  const auto judged = RunProgram({"convert", file, "--height", "1.8", "--strict", "-o", motion});
  EXPECT_EQ(judged.exit_code, 3) << judged.err;
  EXPECT_THAT(judged.out, HasSubstr("verdict    failed"));
  EXPECT_THAT(ReadText(motion), HasSubstr("</MMM>"));
  const auto good = RunProgram(
      {"convert", Handstand(), "--height", "1.8", "--strict", "-c", "s2kf_default", "-o", motion});
  EXPECT_EQ(good.exit_code, 0) << good.err;
}

TEST(Verdict, MarkersOfAnotherPerson) {
  const MarkerSequence& sample = Sample();
  const auto other = [&](int k, int i) -> Eigen::Vector3d {
    return sample.frame((k + 100) % sample.num_frames()).col(i) + Eigen::Vector3d(1, 0.5, 0);
  };
  for (const int every : {2, 7}) {
    const Judged judged = ConvertMarkers(Changed([&](int k, int i, Point p) {
      if (i % every == 0) p = other(k, i);
    }));
    EXPECT_EQ(judged.level, "failed") << every;
    EXPECT_THAT(judged.reasons, HasSubstr("are they this person's?")) << every;
  }
}

TEST(Verdict, NoPersonAtAll) {
  std::vector<std::string> labels = Sample().labels();
  SeededRandom random(1);
  for (int i = static_cast<int>(labels.size()) - 1; i > 0; --i) {
    std::swap(labels[i], labels[random.UniformIndex(i)]);
  }
  EXPECT_EQ(ConvertMarkers(Relabelled(labels)).level, "failed");
  SeededRandom normal(1);
  EXPECT_EQ(ConvertMarkers(Changed([&](int, int, Point p) {
              for (double& x : p) x = 0.6 * normal.Normal();
            })).level,
            "failed");
  EXPECT_EQ(ConvertMarkers(Changed([](int, int, Point p) { p.setConstant(0.3); })).level, "failed");
  // Centimetres that are inches, and metres that are millimetres.
  EXPECT_EQ(ConvertMarkers(Changed([](int, int, Point p) { p /= 2.54; })).level, "failed");
  EXPECT_EQ(ConvertMarkers(Sample(), {"--height", "1.8", "--unit", "m"}).level, "failed");
}

TEST(Verdict, NoiseIsToBeChecked) {
  SeededRandom normal(1);
  const Judged judged = ConvertMarkers(Changed([&](int, int, Point p) {
    for (double& x : p) x += 0.01 * normal.Normal();
  }));
  EXPECT_NE(judged.level, "good");
  EXPECT_THAT(judged.reasons, HasSubstr("noise of"));
}

TEST(Verdict, LimbsThatNoMarkersShow) {
  Judged judged = ConvertMarkers(Only([](const std::string& label) {
    return label == "LFHD" || label == "RFHD" || label == "C7" || label == "LPSI" ||
           label == "RPSI";
  }));
  EXPECT_EQ(judged.level, "failed");
  EXPECT_THAT(judged.reasons, HasSubstr("5 markers are too few"));
  judged = ConvertMarkers(
      Only([](const std::string& label) { return !(label[0] == 'L' && IsOfLeg(label)); }));
  EXPECT_EQ(judged.level, "check");
  EXPECT_THAT(judged.reasons, HasSubstr("too few markers to know the left leg"));
}

TEST(Verdict, LongGaps) {
  Judged judged = ConvertMarkers(testing::HideAllMarkers(Sample(), 60, 165));
  EXPECT_EQ(judged.level, "check");
  EXPECT_THAT(judged.reasons, HasSubstr("the body is hidden for 1.1 s, frames 60 to 164"));
  std::vector<std::string> of_leg;
  for (const std::string& label : Sample().labels()) {
    if (label[0] == 'L' && IsOfLeg(label)) of_leg.push_back(label);
  }
  judged = ConvertMarkers(testing::HideMarkers(Sample(), of_leg, 60, 165));
  EXPECT_EQ(judged.level, "check");
  EXPECT_THAT(judged.reasons, HasSubstr("the left leg is hidden for 1.1 s"));
}

TEST(Verdict, GapsOfHalfASecond) {
  const MarkerSequence once = testing::HideAllMarkers(Sample(), 60, 110);
  Judged judged = ConvertMarkers(once);
  EXPECT_EQ(judged.level, "check");
  EXPECT_THAT(judged.reasons, HasSubstr("the body is hidden for 0.5 s, frames 60 to 109;"));
  judged = ConvertMarkers(testing::HideAllMarkers(once, 140, 190));
  EXPECT_THAT(judged.reasons,
              HasSubstr("frames 60 to 109; the body is hidden for 0.5 s, frames 140 to 189;"));
}

// Frames that are not tracked count in no distance: a marker of a late person is as far from the
// first posture as the person comes.
TEST(Verdict, WhoComesLateIsNotFarFromTheModel) {
  const Judged judged = ConvertMarkers(Changed([](int k, int i, Point p) {
    if (k < 60 && i > 2) p.setConstant(kNaN);
    if (k < 60 && i <= 2) p += Eigen::Vector3d(2, 0, 0);
  }));
  EXPECT_EQ(judged.level, "check");
  EXPECT_THAT(judged.reasons, HasSubstr("too few markers to begin, for 0.6 s, frames 0 to 59"));
  EXPECT_THAT(judged.reasons, Not(HasSubstr("from the model")));
}

// Who comes in little by little is tracked backward from where most of the body is there.
TEST(Verdict, WhoComesInPartIsTrackedFromThreeMarkersOn) {
  const MarkerSequence markers = Changed([](int k, int i, Point p) {
    if (k < 60 && i > 8) p.setConstant(kNaN);
  });
  for (const char* preset : {"s2kf_default", "s2kf_offline"}) {
    const Judged judged = ConvertMarkers(markers, {"--height", "1.8", "-c", preset});
    EXPECT_THAT(judged.reasons, Not(HasSubstr("too few markers to begin"))) << preset;
    EXPECT_THAT(judged.reasons, Not(HasSubstr("from the model"))) << preset;
  }
}

TEST(Verdict, AMarkerThatIsFarForAMoment) {
  const Judged judged = ConvertMarkers(Changed([](int k, int i, Point p) {
    if (i == 5 && k >= 100 && k < 103) p += Eigen::Vector3d(0, 0, 0.6);
  }));
  EXPECT_EQ(judged.level, "check");
  EXPECT_THAT(judged.reasons, HasSubstr("in 3 frames a marker is more than 300 mm from the model"));
  EXPECT_THAT(judged.reasons, HasSubstr("farthest is " + Sample().labels()[5] + " in frame 10"));
}

// The foot turns to the heel, so that the heel's own distance is what right ones have, too. Much of
// the hip is taken up by the posture of a single frame, but not by those of all together.
TEST(Verdict, ALabelThatIsWornElsewhere) {
  for (const auto& [label, way] : {std::pair("LHEE", 0.16), {"LASI", 0.16}, {"LHIP", 0.16}}) {
    const int moved = Sample().FindLabel(label);
    const Judged judged = ConvertMarkers(Changed([&, z = way](int, int i, Point p) {
      if (i == moved) p.z() -= z;
    }));
    EXPECT_EQ(judged.level, "check");
    EXPECT_THAT(judged.reasons,
                HasSubstr(std::string("far from where their names say: ") + label + " (1"));
  }
}

TEST(Verdict, ALabelThatIsFarInSingleFramesIsWornWhereItsNameSays) {
  const int moved = Sample().FindLabel("LHIP");
  const Judged judged = ConvertMarkers(Changed([&](int k, int i, Point p) {
    if (i == moved && k % 40 < 6) p.y() += 2.5;
  }));
  EXPECT_THAT(judged.reasons, Not(HasSubstr("far from where their names say")));
}

TEST(Verdict, AnotherPersonUnderTheSameLabels) {
  const Judged judged = ConvertMarkers(Changed([&](int k, int, Point p) {
    if (k >= 100) p.x() += 0.4;
  }));
  EXPECT_EQ(judged.level, "check");
  EXPECT_THAT(judged.reasons, HasSubstr("jump 1 time by up to 390 mm within a frame, first in"));
}

TEST(Verdict, IsInThePageToo) {
  const std::string page = TestFolder() + "/page.html";
  const std::string file = TestFolder() + "/made.c3d";
  WriteC3d(file, testing::HideAllMarkers(Sample(), 60, 165));
  const auto run = RunProgram(
      {"convert", file, "--height", "1.8", "-o", TestFolder() + "/o.xml", "--report", page});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(ReadText(page), HasSubstr("Verdict: check: the body is hidden"));
}

}  // namespace
}  // namespace mmm_converter
