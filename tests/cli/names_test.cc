// SPDX-License-Identifier: MIT
// Labels of another laboratory: every command understands them by their names, without an option.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "common/io/c3d/c3d_writer.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/io/recording/recording.h"
#include "common/support/units.h"
#include "tests/cli/program.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using testing::Handstand;
using ::testing::HasSubstr;
using testing::ReadText;
using testing::RunProgram;
using testing::TestFolder;
using testing::WriteText;

// KIT's names of the sample's markers, by those of the CAST protocol; # is a side. Of thighs and
// shanks the names tell the segment only.
const std::map<std::string, std::string>& NamesOfCast() {
  static const std::map<std::string, std::string> kNames = {
      {"#FHD", "#_HDF"}, {"#BHD", "#_HDB"}, {"C7", "CV7"},     {"CLAV", "SNJ"},
      {"STRN", "SXS"},   {"T10", "TV10"},   {"#SHO", "#_SAJ"}, {"#AEL", "#_HLE"},
      {"#WTS", "#_RSP"}, {"#WPS", "#_USP"}, {"#ASI", "#_IAS"}, {"#PSI", "#_IPS"},
      {"#HIP", "#_FTC"}, {"#KNE", "#_FLE"}, {"#ANK", "#_FAL"}, {"#HEE", "#_FCC"},
      {"#MT1", "#_FM1"}, {"#MT5", "#_FM5"}, {"#THI", "#_TH1"}, {"#TIP", "#_SK1"}};
  return kNames;
}

std::string WithSide(std::string name, char side) {
  std::replace(name.begin(), name.end(), '#', side);
  return name;
}

// Frames of the sample, the first `hidden` of them without any marker, those before `part` with the
// first ten, T10 worn lower [m].
std::string Renamed(int first, int end, int hidden = 0, int part = 0, double lower = 0) {
  const MarkerSequence sample = ReadRecording(Handstand(), {}).markers.Slice(first, end);
  std::vector<std::string> labels;
  std::vector<int> columns;
  for (const auto& [kit, cast] : NamesOfCast()) {
    for (const char side : {'L', 'R'}) {
      const bool has_side = kit.front() == '#';
      if (side == 'R' && !has_side) continue;
      columns.push_back(sample.FindLabel(WithSide(kit, side)));
      labels.push_back(WithSide(cast, side));
    }
  }
  MarkerSequence renamed(labels, sample.num_frames(), sample.rate(), 0);
  for (int k = 0; k < sample.num_frames(); ++k) {
    if (k < hidden) {
      renamed.frame(k).setConstant(kNaN);
    } else {
      renamed.frame(k) = sample.frame(k)(Eigen::all, columns);
      if (k < part) renamed.frame(k).rightCols(renamed.num_labels() - 10).setConstant(kNaN);
      if (lower > 0) renamed.frame(k)(2, renamed.FindLabel("TV10")) -= lower;
    }
  }
  std::string file = TestFolder() + "/cast.c3d";
  WriteC3d(file, renamed);
  return file;
}

constexpr const char* kAllUnderstood = "names      36 of 36 labels by their names";

testing::ProgramRun RunWell(const std::vector<std::string>& words) {
  auto run = RunProgram(words);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return run;
}

double LargestDeviation(const std::string& motion, const std::string& other) {
  const PoseTrajectory a = ReadMmmMotionFile(motion).motions.front().trajectory;
  const PoseTrajectory b = ReadMmmMotionFile(other).motions.front().trajectory;
  EXPECT_EQ(a.num_frames(), b.num_frames());
  double largest = 0;
  for (int k = 0; k < std::min(a.num_frames(), b.num_frames()); ++k) {
    largest = std::max(largest, Local(a.postures[k], b.postures[k]).lpNorm<Eigen::Infinity>());
  }
  return largest;
}

TEST(Names, AreUnderstoodByAConversionAndWrittenAsAMarkerSet) {
  const std::string& folder = TestFolder();
  const std::string file = Renamed(50, 110);
  const auto run = RunWell({"convert", file, "--height", "1.8", "-o", folder + "/a.xml",
                            "--marker-set-out", folder + "/set.xml"});
  EXPECT_THAT(run.out, HasSubstr(kAllUnderstood));
  RunWell({"convert", file, "--height", "1.8", "-o", folder + "/b.xml", "--marker-set",
           folder + "/set.xml"});
  EXPECT_LT(LargestDeviation(folder + "/a.xml", folder + "/b.xml"), 1e-3);
}

TEST(Names, ALabelThatIsFarFromItsPlaceIsSaid) {
  const auto run = RunWell(
      {"convert", Renamed(50, 110, 0, 0, 0.15), "--height", "1.8", "-o", TestFolder() + "/a.xml"});
  EXPECT_THAT(run.out, HasSubstr("verdict    check"));
  EXPECT_THAT(run.out, AllOf(HasSubstr("labels that are far from where their names say: "),
                             HasSubstr("TV10 (1")));
}

// MMM files have 8 decimals. No height is given: the file that is played tells it. Who comes late
// and in part is tracked from the same frame on, and backward from there.
TEST(Names, MeanTheSameInAReplay) {
  const std::string& folder = TestFolder();
  for (const int hidden : {0, 20}) {
    const std::string file = Renamed(50, 110 + 4 * hidden, hidden, 6 * hidden);
    const auto run = RunWell({"live", "replay:" + file + "@max", "-o", folder + "/live.xml"});
    EXPECT_THAT(run.out, HasSubstr(kAllUnderstood));
    RunWell({"convert", file, "-o", folder + "/converted.xml"});
    EXPECT_LT(LargestDeviation(folder + "/live.xml", folder + "/converted.xml"), 2e-8) << hidden;
  }
}

TEST(Names, AreUnderstoodByReportsComparisonsAndExports) {
  const std::string& folder = TestFolder();
  const std::string file = Renamed(50, 110);
  RunWell({"convert", file, "--height", "1.8", "-o", folder + "/a.xml"});
  const auto report = RunWell({"report", file, folder + "/a.xml", "-o", folder + "/a.html"});
  EXPECT_THAT(report.out, HasSubstr("markers and 44 joints compared"));
  EXPECT_THAT(ReadText(folder + "/a.html"), HasSubstr("L_IAS"));
  const auto poses = RunWell({"export-poses", folder + "/a.xml", "-o", folder + "/a.csv"});
  EXPECT_THAT(poses.out, HasSubstr("60 frames"));
  const auto compare = RunWell({"compare", file, "--height", "1.8", "-c", "jacobian_pull", "--json",
                                folder + "/compare.json"});
  EXPECT_THAT(compare.out, HasSubstr("markers and 44 joints compared"));
}

TEST(Names, AreUnderstoodInABatch) {
  const std::string& folder = TestFolder();
  Renamed(50, 110);
  WriteText(folder + "/batch.xml",
            "<Batch height_m='1.8'><Recording file='cast.c3d' id='walk'/></Batch>");
  RunWell({"batch", folder + "/batch.xml", "-o", folder + "/out", "--reports", "none"});
  RunWell({"convert", folder + "/cast.c3d", "--height", "1.8", "-o", folder + "/a.xml"});
  EXPECT_LT(LargestDeviation(folder + "/a.xml", folder + "/out/motions/walk.xml"), 1e-6);
}

// An arm and a trunk, and RTB, which would be a shank: no leg comes from it.
TEST(Names, OfAnArmFoldNoLegOntoIt) {
  const MarkerSequence sample = ReadRecording(Handstand(), {}).markers.Slice(50, 110);
  const std::vector<std::string> kit = {"C7",   "T10",  "CLAV", "STRN",
                                        "RAEL", "RWTS", "RWPS", "RSHO"};
  std::vector<int> columns;
  for (const std::string& one : kit) columns.push_back(sample.FindLabel(one));
  MarkerSequence arm({"C7", "T10", "CLAV", "STRN", "RELB", "RWRA", "RWRB", "RTB"},
                     sample.num_frames(), sample.rate(), 0);
  for (int k = 0; k < sample.num_frames(); ++k) {
    arm.frame(k) = sample.frame(k)(Eigen::all, columns);
  }
  const std::string file = TestFolder() + "/arm.c3d";
  WriteC3d(file, arm);
  RunWell({"convert", file, "-o", TestFolder() + "/arm.xml"});
  const PoseTrajectory found =
      ReadMmmMotionFile(TestFolder() + "/arm.xml").motions.front().trajectory;
  const auto hip = std::find(found.joint_names.begin(), found.joint_names.end(), "RHx_joint");
  ASSERT_NE(hip, found.joint_names.end());
  EXPECT_LT(std::abs(found.postures[30].joint_angles[hip - found.joint_names.begin()]), 0.1);
}

// Where markers sit that only their names place is the person's, too.
TEST(Names, OfACalibratedPersonAreThoseOfTheCalibration) {
  const std::string& folder = TestFolder();
  const std::string file = Renamed(50, 350);
  const std::string subject = folder + "/anna.xml";
  const auto distance_of = [&](const std::vector<std::string>& options) {
    std::vector<std::string> words = {"convert",         file,        "-o",
                                      folder + "/a.xml", "--summary", folder + "/a.json"};
    words.insert(words.end(), options.begin(), options.end());
    RunWell(words);
    const auto summary = nlohmann::json::parse(ReadText(folder + "/a.json"));
    return summary["distance_mm"]["mean"].get<double>();
  };
  RunWell({"calibrate", file, "--height", "1.8", "-o", subject});
  const double calibrated = distance_of({"--subject-file", subject});
  EXPECT_LT(calibrated, 0.6 * distance_of({"--height", "1.8"}));
  const std::string own = folder + "/own.xml";
  const double itself = distance_of({"--height", "1.8", "--self-calibrate", "--subject-out", own});
  EXPECT_NEAR(itself, calibrated, 1);
  EXPECT_NEAR(distance_of({"--subject-file", own}), itself, 1);
  RunWell(
      {"live", "replay:" + file + "@max", "--subject-file", subject, "-o", folder + "/live.xml"});
  RunWell({"convert", file, "--subject-file", subject, "-o", folder + "/b.xml"});
  EXPECT_LT(LargestDeviation(folder + "/live.xml", folder + "/b.xml"), 2e-8);
}

}  // namespace
}  // namespace mmm_converter
