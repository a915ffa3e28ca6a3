// SPDX-License-Identifier: MIT
// A model of OpenSim as the model of a conversion.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "common/io/c3d/c3d_writer.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/io/osim/osim_model_reader.h"
#include "common/model/coordinate_map.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/marker_synthesis.h"
#include "tests/cli/program.h"
#include "tests/support/osim_texts.h"
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

constexpr int kOsimFrames = 60;
constexpr double kDegrees = 180 / std::numbers::pi;

/// A model file, and a recording of it in which all coordinates move.
struct OsimCase {
  std::string model_file, recording;
  KinematicModel model;
  PoseTrajectory truth;
};

OsimCase MakeCase(const std::string& text, const std::string& name) {
  OsimCase made = {TestFolder() + "/" + name + ".osim",
                   TestFolder() + "/" + name + ".c3d",
                   ParseOsimModel(text, name),
                   {}};
  WriteText(made.model_file, text);
  PoseTrajectory& motion = made.truth;
  motion.rate = 100;
  for (int j = 0; j < made.model.num_joints(); ++j) {
    motion.joint_names.push_back(made.model.joint(j).name);
  }
  for (int k = 0; k < kOsimFrames; ++k) {
    Posture& q = motion.postures.emplace_back(ZeroPosture(made.model));
    const double t = k / motion.rate;
    if (!made.model.is_root_fixed()) {
      q.position = {0.1 * t, 0.2, 0.9 + 0.05 * std::sin(6 * t)};
      q.orientation = Eigen::Quaterniond(made.model.coordinates()->R_WG()) *
                      Eigen::AngleAxisd(0.5 * t, Eigen::Vector3d::UnitY());
    }
    for (int j = 0; j < made.model.num_joints(); ++j) {
      const double reach = made.model.joint(j).type == JointType::kSliding ? 0.05 : 0.2;
      q.joint_angles[j] += reach * std::sin((2 + 0.1 * j) * t);
    }
  }
  WriteC3d(made.recording, SynthesizeMarkers(made.model, motion, {0, 0, 1, 0}, 1));
  return made;
}

/// The largest error of a coordinate in the second half [deg, mm].
double LargestCoordinateError(const OsimCase& made, const StrictTable& table) {
  const auto& all = made.model.coordinates()->coordinates();
  EXPECT_EQ(table.columns.size(), all.size() + 1);
  EXPECT_EQ(table.rows.size(), kOsimFrames);
  CoordinateSeries series(made.model);
  double largest = 0;
  for (int k = 0; k < kOsimFrames; ++k) {
    const Eigen::VectorXd values = series.Next(made.truth.postures[k]);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double truth = values[static_cast<Eigen::Index>(i)];
      const double found = table.At(k, all[i].name);
      const bool is_turn = all[i].kind == ModelCoordinate::Kind::kTurn;
      if (2 * k < kOsimFrames) continue;
      largest = std::max(
          largest, is_turn ? std::abs(found - kDegrees * truth) : 1e3 * std::abs(found - truth));
    }
  }
  return largest;
}

std::string Floating() { return testing::OsimOfAllKinds(); }

std::string Grounded() {
  std::string text = testing::OsimOfAllKinds();
  const std::string tz = "<Coordinate name=\"tz\">";
  return text.insert(text.find(tz) + tz.size(), "<locked>true</locked>");
}

// Least squares end within a tolerance of their own; C3D has floats of millimetres.
constexpr double kFitted = 0.05;
// The filter weighs markers against where joints were: it is behind what moves.
constexpr double kFiltered = 5;

TEST(Osim, KnownCoordinatesAreRecovered) {
  for (const auto& [text, name] : {std::pair(Floating(), "floating"), {Grounded(), "grounded"}}) {
    const OsimCase made = MakeCase(text, name);
    const std::string output = TestFolder() + "/" + name + ".mot";
    for (const char* config : {"jacobian_opensim", "s2kf_default", "s2kf_offline"}) {
      std::filesystem::remove(output);
      const auto run =
          RunProgram({"convert", made.recording, "--model", made.model_file, "-c", config,
                      "--report", TestFolder() + "/o.html", "--summary", TestFolder() + "/o.json"});
      ASSERT_EQ(run.exit_code, 0) << run.err;
      const StrictTable table = ReadStrictMot(ReadText(output));
      EXPECT_EQ(table.keys.at("inDegrees"), "yes");
      const bool is_fit = std::string(config) == "jacobian_opensim";
      EXPECT_LT(LargestCoordinateError(made, table), is_fit ? kFitted : kFiltered)
          << name << " " << config;
    }
    const StrictTable deviations =
        ReadStrictMot(ReadText(TestFolder() + "/" + std::string(name) + "_deviations.sto"));
    EXPECT_EQ(deviations.At(30, "mtp_angle"), 0);  // locked
    EXPECT_GT(deviations.At(30, "knee_angle"), 0);
    EXPECT_GT(deviations.At(30, "patella_angle"), 0);  // follows the knee
  }
}

TEST(Osim, WritesWhatOpenSimReports) {
  const OsimCase made = MakeCase(Floating(), "reported");
  const std::string base = TestFolder() + "/reported";
  const auto run =
      RunProgram({"convert", made.recording, "--model", made.model_file, "-c", "jacobian_opensim",
                  "-o", base + "_o.xml", "--export-mot", base + "_e.mot", "--export-marker-errors",
                  base + "_errors.sto", "--export-model-markers", base + "_markers.sto"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_LT(LargestCoordinateError(made, ReadStrictMot(ReadText(base + "_e.mot"))), kFitted);
  const StrictTable errors = ReadStrictMot(ReadText(base + "_errors.sto"));
  EXPECT_LT(errors.At(40, "marker_error_max"), 1e-4);
  EXPECT_LE(errors.At(40, "hand2"), errors.At(40, "marker_error_max"));
  const StrictTable markers = ReadStrictMot(ReadText(base + "_markers.sto"));
  const Eigen::Vector3d p_GM =
      made.model.coordinates()->R_WG().transpose() *
      MarkerPositions(made.model, made.truth.postures[40]).col(made.model.FindMarker("hand2"));
  EXPECT_NEAR(markers.At(40, "hand2_tx"), p_GM.x(), 1e-4);
  EXPECT_NEAR(markers.At(40, "hand2_ty"), p_GM.y(), 1e-4);
  const MmmMotion motion = ReadMmmMotionFile(base + "_o.xml").motions.at(0);
  EXPECT_THAT(motion.model_path, ::testing::EndsWith("reported.osim"));
  EXPECT_EQ(motion.trajectory.joint_names, made.truth.joint_names);
  const auto poses = RunProgram({"export-poses", base + "_o.xml", "-o", base + "_poses.csv"});
  EXPECT_EQ(poses.exit_code, 0) << poses.err;
}

TEST(Osim, MarkersMayComeFromAFileAndTasksWeighThem) {
  OsimCase made = MakeCase(Floating(), "tasks");
  std::string bare = Floating();
  const auto begin = bare.find("<MarkerSet");
  const std::string set = bare.substr(begin, bare.find("</Model>") - begin);
  WriteText(TestFolder() + "/bare.osim", bare.erase(begin, set.size()));
  WriteText(TestFolder() + "/set.xml",
            "<OpenSimDocument Version=\"40000\">" + set + "</OpenSimDocument>");
  std::string tasks =
      "<IKCoordinateTask name=\"knee_angle\"><weight>1000</weight><value_type>"
      "manual_value</value_type><value>-0.5</value></IKCoordinateTask>";
  for (const ModelMarker& marker : made.model.markers()) {
    if (marker.name == "hand3") continue;
    tasks += "<IKMarkerTask name=\"" + marker.name + "\"><weight>2</weight></IKMarkerTask>";
  }
  WriteText(TestFolder() + "/tasks.xml",
            "<OpenSimDocument Version=\"20303\"><IKTaskSet><objects>" + tasks +
                "</objects></IKTaskSet></OpenSimDocument>\n</objects>");
  for (const char* config : {"jacobian_opensim", "s2kf_default"}) {
    const std::string output = TestFolder() + "/tasks.mot";
    const auto run = RunProgram({"convert", made.recording, "--model", TestFolder() + "/bare.osim",
                                 "--marker-file", TestFolder() + "/set.xml", "--marker-set",
                                 TestFolder() + "/tasks.xml", "-c", config, "-o", output});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out + run.err, HasSubstr("1 labels ignored"));  // hand3 has no task
    EXPECT_NEAR(ReadStrictMot(ReadText(output)).At(50, "knee_angle"), -0.5 * kDegrees, 0.1);
  }
}

// Labels of another laboratory are the model's markers of the same landmarks.
TEST(Osim, LabelsAreUnderstoodByTheirLandmarks) {
  std::string text = Floating();
  const std::vector<std::array<const char*, 3>> names = {{"hand1", "R.ASIS", "RASI"},
                                                         {"hand2", "L.ASIS", "LASI"},
                                                         {"hand3", "V.Sacral", "SACR"},
                                                         {"patella1", "R.Knee.Lat", "RKNE"},
                                                         {"patella2", "L.Knee.Lat", "LKNE"}};
  for (const auto& [marker, landmark, unused] : names) {
    const std::string before = std::string("name=\"") + marker + "\"";
    text.replace(text.find(before), before.size(), std::string("name=\"") + landmark + "\"");
  }
  const OsimCase made = MakeCase(text, "landmarks");
  const MarkerSequence seen = SynthesizeMarkers(made.model, made.truth, {0, 0, 1, 0}, 1);
  std::vector<std::string> labels = seen.labels();
  for (std::string& label : labels) {
    for (const auto& [unused, landmark, other] : names) {
      if (label == landmark) label = other;
    }
  }
  MarkerSequence renamed(labels, seen.num_frames(), seen.rate(), seen.first_time());
  for (int k = 0; k < seen.num_frames(); ++k) renamed.frame(k) = seen.frame(k);
  WriteC3d(made.recording, renamed);
  const auto run = RunProgram({"convert", made.recording, "--model", made.model_file, "-c",
                               "jacobian_opensim", "-o", TestFolder() + "/landmarks.mot"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("36 used"), HasSubstr("(OpenSim, \"landmarks\")")));
  EXPECT_LT(LargestCoordinateError(made, ReadStrictMot(ReadText(TestFolder() + "/landmarks.mot"))),
            kFitted);
}

TEST(Osim, InfoDescribesIt) {
  const OsimCase made = MakeCase(Floating(), "described");
  const auto run = RunProgram({"info", made.model_file});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out,
              AllOf(HasSubstr("OpenSim model made, version 40000"), HasSubstr("2 PinJoint"),
                    HasSubstr("follows knee_angle"), HasSubstr("locked at 0.2"),
                    HasSubstr("tracked within its range"), HasSubstr("of the floating root")));
  EXPECT_THAT(RunProgram({"info", made.model_file, "--json"}).out,
              HasSubstr("\"root\": \"floats\""));
}

TEST(Osim, WhatCannotBeDoneWithItIsSaidBeforeTheWork) {
  const OsimCase floating = MakeCase(Floating(), "refused");
  const OsimCase grounded = MakeCase(Grounded(), "refused_ground");
  const auto refusal = [](std::vector<std::string> arguments) {
    const auto run = RunProgram(arguments);
    EXPECT_EQ(run.exit_code, 1) << arguments.front() << run.err;
    return run.err;
  };
  const std::string out = TestFolder() + "/refused_o";
  EXPECT_THAT(
      refusal({"convert", grounded.recording, "--model", grounded.model_file, "-o", out + ".xml"}),
      HasSubstr("give the output the ending .mot"));
  EXPECT_THAT(refusal({"convert", floating.recording, "--model", floating.model_file, "-o",
                       out + ".mot", "--export-bvh", out + ".bvh"}),
              HasSubstr("joints that turn only"));
  EXPECT_THAT(
      refusal({"label", grounded.recording, "--model", grounded.model_file, "-o", out + ".c3d"}),
      HasSubstr("can't be done with a model of OpenSim"));
  EXPECT_THAT(refusal({"convert", floating.recording, "--marker-file", floating.model_file, "-o",
                       out + ".xml"}),
              HasSubstr("is a set of markers for a model of OpenSim"));
  EXPECT_FALSE(std::filesystem::exists(out + ".mot"));
}

}  // namespace
}  // namespace mmm_converter
