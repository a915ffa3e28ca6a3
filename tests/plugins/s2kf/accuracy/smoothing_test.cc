// SPDX-License-Identifier: MIT
// What the offline preset must show on motions whose truth is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "common/convert/converter_config.h"
#include "common/fit/posture_fit.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/marker_residuals.h"
#include "common/motion/marker_synthesis.h"
#include "plugins/s2kf/s2kf_converter.h"
#include "tests/plugins/s2kf/tracking_run.h"
#include "tests/support/acrobatics.h"
#include "tests/support/changed_markers.h"
#include "tests/support/shared_data.h"

namespace mmm_converter::s2kf {
namespace {

using Eigen::MatrixXd;

S2kfSettings OfflineSettings() {
  return ReadSettings(
      ReadConverterConfig(testing::SourcePath("xml_config/converters/s2kf_offline.xml")));
}

S2kfSettings WithoutSmoothing(S2kfSettings settings) {
  settings.smoothing = false;
  return settings;
}

/// A person, a motion and markers made from it.
struct SmoothedScene {
  SmoothedScene(PoseTrajectory trajectory, int num_joints, std::uint64_t seed,
                const MarkerErrors& marker_errors = MarkerErrors{})
      : motion(std::move(trajectory)),
        errors(marker_errors),
        joints(MotionJoints(model, num_joints)),
        markers(SynthesizeMarkers(model, motion, errors, seed)),
        assignments(AssignAll(model, markers)) {}

  ConversionResult Convert(const S2kfSettings& settings, const MarkerSequence& seen) const {
    return S2kfConverter(SetupOf(model, joints, assignments), settings).Convert(seen, {});
  }

  /// The tracked joints' true angles, joints x frames.
  MatrixXd TrueAngles() const {
    MatrixXd angles(joints.size(), motion.num_frames());
    for (int k = 0; k < motion.num_frames(); ++k) {
      angles.col(k) = ModelPosture(model, motion, k).joint_angles(joints);
    }
    return angles;
  }

  KinematicModel model = ScaledReferenceModel(1.8);
  PoseTrajectory motion;
  MarkerErrors errors;
  std::vector<int> joints;
  MarkerSequence markers;
  std::vector<MarkerAssignment> assignments;
};

PoseTrajectory RecordedScene(const std::string& file) {
  return LowPassed(
      ReadMmmMotionFile(testing::SharedData("mmm/motions_legacy/" + file)).motions[0].trajectory);
}

SmoothedScene Walking() { return {RecordedScene("walking_medium01_motion395.xml"), 44, 1}; }
SmoothedScene SmoothedQuickMotion() {
  return {RecordedScene("test_mmm_subject314_40joints_100Hz.xml"), 40, 2};
}
SmoothedScene SmoothedHandstand() {
  return {testing::MakeKickedHandstand(ScaledReferenceModel(1.8)), 44, 1};
}

MatrixXd Angles(const PoseTrajectory& trajectory) {
  MatrixXd angles(trajectory.joint_names.size(), trajectory.num_frames());
  for (int k = 0; k < trajectory.num_frames(); ++k) {
    angles.col(k) = trajectory.postures[k].joint_angles;
  }
  return angles;
}

/// Second differences [rad/s^2] at 100 Hz.
MatrixXd Accelerations(const MatrixXd& angles) {
  const Eigen::Index n = angles.cols() - 2;
  return 1e4 * (angles.rightCols(n) - 2 * angles.middleCols(1, n) + angles.leftCols(n));
}

double Rms(const MatrixXd& values) {
  return std::sqrt(values.squaredNorm() / static_cast<double>(values.size()));
}

/// The largest step of a joint in a frame in which its true step is below 0.05 rad.
double LargestStep(const MatrixXd& angles, const MatrixXd& truth) {
  double largest = 0;
  for (Eigen::Index k = 1; k < angles.cols(); ++k) {
    for (Eigen::Index j = 0; j < angles.rows(); ++j) {
      if (std::abs(truth(j, k) - truth(j, k - 1)) >= 0.05) continue;
      largest = std::max(largest, std::abs(angles(j, k) - angles(j, k - 1)));
    }
  }
  return largest;
}

/// The best posture of each frame by itself, from the frame before.
MatrixXd FramewiseFit(const SmoothedScene& scene) {
  const std::vector<LabelIx> labels = LabelIndices(scene.assignments);
  const MarkerKinematics kinematics(scene.model, scene.joints, MarkerIndices(scene.assignments));
  PostureFit fit(kinematics);
  PostureFitOptions options;
  options.tolerance = 1e-6;
  const Eigen::VectorXd scale = Eigen::VectorXd::Ones(kinematics.num_markers());
  Posture q = ModelPosture(scene.model, scene.motion, 0);
  q.joint_angles = Eigen::VectorXd(q.joint_angles(scene.joints));
  MatrixXd angles(scene.joints.size(), scene.motion.num_frames());
  for (int k = 0; k < scene.motion.num_frames(); ++k) {
    fit.Solve(scene.markers.frame(k)(Eigen::all, labels), scale, options, &q);
    angles.col(k) = q.joint_angles;
  }
  return angles;
}

void ExpectInsideLimits(const SmoothedScene& scene, const PoseTrajectory& trajectory) {
  for (const Posture& q : trajectory.postures) {
    for (std::size_t j = 0; j < scene.joints.size(); ++j) {
      const Segment& joint = scene.model.joint(scene.joints[j]);
      // The sine of a number, times half the range: rounding.
      ASSERT_GE(q.joint_angles[j], joint.lower - 1e-12);
      ASSERT_LE(q.joint_angles[j], joint.upper + 1e-12);
    }
  }
}

/// What the markers of KIT's set determine well: shoulders, elbows, hips, knees in flexion and
/// abduction. RecordedScene angles of necks, ankles' twists and toes jump, as no marker shows them.
bool IsLarge(const std::string& joint) {
  const std::vector<std::string> names = {"LSx_joint", "LSy_joint", "RSx_joint", "RSy_joint",
                                          "LEx_joint", "REx_joint", "LHx_joint", "LHy_joint",
                                          "RHx_joint", "RHy_joint", "LKx_joint", "RKx_joint"};
  return std::find(names.begin(), names.end(), joint) != names.end();
}

MatrixXd LargeJoints(const SmoothedScene& scene, const MatrixXd& values) {
  std::vector<int> rows;
  for (std::size_t j = 0; j < scene.joints.size(); ++j) {
    if (IsLarge(scene.model.joint(scene.joints[j]).name)) rows.push_back(static_cast<int>(j));
  }
  return values(rows, Eigen::all);
}

struct Figures {
  double jitter = 0;        // rms acceleration over that of the truth
  double jitter_large = 0;  // of large joints
  double framewise = 0;     // the framewise fit's over the smoothed one's
  double step = 0;          // LargestStep
};

Figures Measure(const std::string& name, const SmoothedScene& scene) {
  const ConversionResult smoothed = scene.Convert(OfflineSettings(), scene.markers);
  S2kfSettings settings = WithoutSmoothing(OfflineSettings());
  settings.choose_process_noise_scale = false;
  settings.process_noise_scale = smoothed.process_noise_scale.value_or(1);
  const ConversionResult filtered = scene.Convert(settings, scene.markers);
  ExpectInsideLimits(scene, smoothed.trajectory);
  const MatrixXd truth = Accelerations(scene.TrueAngles());
  const MatrixXd found = Accelerations(Angles(smoothed.trajectory));
  const MatrixXd online = Accelerations(Angles(filtered.trajectory));
  Figures figures;
  figures.jitter = Rms(found) / Rms(truth);
  figures.jitter_large = Rms(LargeJoints(scene, found)) / Rms(LargeJoints(scene, truth));
  figures.framewise = Rms(Accelerations(FramewiseFit(scene))) / Rms(found);
  figures.step = LargestStep(Angles(smoothed.trajectory), scene.TrueAngles());
  const double distance = SummarizeResiduals(smoothed.residuals).mean;
  const double filter_distance = SummarizeResiduals(filtered.residuals).mean;
  std::printf(
      "[ measured ] %s: jitter %.2f of the truth's, of large joints %.2f, 1/%.0f of the framewise "
      "fit's; error of accelerations %.1f rad/s^2 (filter %.1f, truth is %.1f); largest step %.3f "
      "rad; distance %.2f mm (filter %.2f); noise times %.3g\n",
      name.c_str(), figures.jitter, figures.jitter_large, figures.framewise, Rms(found - truth),
      Rms(online - truth), Rms(truth), figures.step, 1e3 * distance, 1e3 * filter_distance,
      smoothed.process_noise_scale.value_or(1));
  EXPECT_GE(figures.framewise, 5);
  EXPECT_LT(Rms(found - truth), Rms(online - truth));
  // With calibrated markers the smoothed motion is nearer to them than the filter's. Where they sit
  // 28 mm off no smooth motion can follow as the filter does: 1.5 %.
  EXPECT_LE(distance, (scene.errors.offset > 0 ? 1.015 : 1.0) * filter_distance);
  return figures;
}

// The errors of calibrated markers: soft tissue and noise.
const MarkerErrors kCalibrated = {0, 0.004, 0.25, 0.0001};

TEST(SmoothingTest, SmoothedHandstand) { Measure("handstand", SmoothedHandstand()); }

TEST(SmoothingTest, Cartwheel) {
  Measure("cartwheel", {testing::MakeCartwheel(ScaledReferenceModel(1.8)), 44, 3});
}

TEST(SmoothingRealFilesTest, WalkingIsAsSmoothAsTheTruthWhereMarkersShowIt) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const Figures raw = Measure("walking", Walking());
  // The project's target, for the joints that have one.
  EXPECT_NEAR(raw.jitter_large, 1, 0.2);
  EXPECT_LE(raw.step, 0.05);
  const Figures calibrated = Measure(
      "walking, calibrated", {RecordedScene("walking_medium01_motion395.xml"), 44, 1, kCalibrated});
  EXPECT_NEAR(calibrated.jitter_large, 1, 0.2);
  EXPECT_LE(calibrated.step, 0.05);
}

TEST(SmoothingRealFilesTest, QuickMotionIsAsSmoothAsTheTruthWhereMarkersShowIt) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const Figures raw = Measure("quick motion", SmoothedQuickMotion());
  EXPECT_NEAR(raw.jitter_large, 1, 0.2);
  const Figures calibrated =
      Measure("quick motion, calibrated",
              {RecordedScene("test_mmm_subject314_40joints_100Hz.xml"), 40, 2, kCalibrated});
  EXPECT_NEAR(calibrated.jitter_large, 1, 0.2);
}

/// Exactly half of all markers hidden throughout; distances to all of them.
void ExpectHalfHiddenIsBorne(const std::string& name, const SmoothedScene& scene) {
  const MarkerSequence seen = testing::OccludeShare(scene.markers, 0.5, 100, 1);
  const ConversionResult result = scene.Convert(OfflineSettings(), seen);
  double mean = 0;
  double worst = 0;
  for (int k = 0; k < result.trajectory.num_frames(); ++k) {
    const Eigen::Matrix3Xd p_WM =
        MarkerPositions(scene.model, ModelPosture(scene.model, result.trajectory, k));
    double frame = 0;
    for (const MarkerAssignment& a : scene.assignments) {
      frame += (scene.markers.frame(k).col(a.label) - p_WM.col(a.marker)).norm();
    }
    frame /= static_cast<double>(scene.assignments.size());
    mean += frame / result.trajectory.num_frames();
    worst = std::max(worst, frame);
  }
  std::printf("[ measured ] %s, calibrated, half hidden: mean %.2f mm, worst frame %.2f; %g\n",
              name.c_str(), 1e3 * mean, 1e3 * worst, result.process_noise_scale.value_or(1));
  // The project's targets.
  EXPECT_LE(mean, 0.008);
  EXPECT_LE(worst, 0.030);
}

TEST(SmoothingTest, HalfOfTheMarkersHiddenOnTheHandstand) {
  ExpectHalfHiddenIsBorne(
      "handstand", {testing::MakeKickedHandstand(ScaledReferenceModel(1.8)), 44, 1, kCalibrated});
}

TEST(SmoothingRealFilesTest, HalfOfTheMarkersHiddenWhileWalking) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  ExpectHalfHiddenIsBorne("walking",
                          {RecordedScene("walking_medium01_motion395.xml"), 44, 1, kCalibrated});
}

/// Frame by frame, over the tracked joints, rms against the truth [rad/s^2].
double AccelerationError(const SmoothedScene& scene, const S2kfSettings& settings,
                         const MarkerSequence& seen) {
  const ConversionResult result = scene.Convert(settings, seen);
  return Rms(Accelerations(Angles(result.trajectory)) - Accelerations(scene.TrueAngles()));
}

// Markers 28 mm beside the model's places pull the limbs over to them when they return, where it is
// not known that they are worn there.
TEST(SmoothingTest, MarkersThatHideAndReturnMoveNoLimb) {
  for (const int seed : {3, 4, 5}) {
    const SmoothedScene scene = {testing::MakeKickedHandstand(ScaledReferenceModel(1.8)), 44,
                                 static_cast<std::uint64_t>(seed)};
    const MarkerSequence seen = testing::OccludeShare(scene.markers, 0.1, 30, seed);
    S2kfSettings settings = OfflineSettings();
    const double learnt = AccelerationError(scene, settings, seen);
    settings.learn_places = false;
    const double as_modelled = AccelerationError(scene, settings, seen);
    std::printf(
        "[ measured ] a tenth hidden, seed %d: error of accelerations %.1f rad/s^2, %.1f with "
        "the model's places\n",
        seed, learnt, as_modelled);
    EXPECT_LT(learnt, 0.5 * as_modelled);
  }
}

TEST(SmoothingTest, TheResultDoesNotDependOnTheChunks) {
  const SmoothedScene scene = SmoothedHandstand();
  const MarkerSequence seen = testing::OccludeShare(scene.markers.Slice(0, 100), 0.3, 20, 1);
  S2kfSettings settings = OfflineSettings();
  settings.choose_process_noise_scale = false;
  const ConversionResult whole = scene.Convert(settings, seen);
  for (const int chunk : {1, 7, 33}) {
    settings.smoothing_chunk = chunk;
    const ConversionResult parts = scene.Convert(settings, seen);
    EXPECT_EQ(Angles(parts.trajectory), Angles(whole.trajectory));
    EXPECT_EQ(parts.trajectory.standard_deviations, whole.trajectory.standard_deviations);
    EXPECT_EQ(parts.trajectory.accelerations, whole.trajectory.accelerations);
  }
}

TEST(SmoothingTest, EndsWithTheFilterAndIsMoreCertainBefore) {
  const SmoothedScene scene = SmoothedHandstand();
  S2kfSettings settings = OfflineSettings();
  settings.choose_process_noise_scale = false;
  const MarkerSequence seen = testing::OccludeShare(scene.markers.Slice(0, 300), 0.3, 50, 1);
  const ConversionResult smoothed = scene.Convert(settings, seen);
  const ConversionResult filtered = scene.Convert(WithoutSmoothing(settings), seen);
  EXPECT_EQ(smoothed.trajectory.postures.back().joint_angles,
            filtered.trajectory.postures.back().joint_angles);
  EXPECT_EQ(smoothed.trajectory.postures.back().position,
            filtered.trajectory.postures.back().position);
  // A hidden marker is known from both sides.
  EXPECT_LT(smoothed.trajectory.standard_deviations.mean(),
            filtered.trajectory.standard_deviations.mean());
}

TEST(SmoothingTest, LeadingFramesWithoutMarkersTakeTheFirstSmoothedPosture) {
  const SmoothedScene scene = SmoothedHandstand();
  const MarkerSequence seen = testing::HideAllMarkers(scene.markers.Slice(0, 80), 0, 10);
  const ConversionResult result = scene.Convert(OfflineSettings(), seen);
  for (int k = 0; k < 10; ++k) {
    EXPECT_EQ(result.trajectory.postures[k].joint_angles,
              result.trajectory.postures[10].joint_angles);
  }
}

TEST(SmoothingTest, OneAndTwoFrames) {
  const SmoothedScene scene = SmoothedHandstand();
  for (const int frames : {1, 2}) {
    const ConversionResult result =
        scene.Convert(OfflineSettings(), scene.markers.Slice(0, frames));
    EXPECT_EQ(result.trajectory.num_frames(), frames);
    EXPECT_TRUE(result.trajectory.velocities.allFinite());
    EXPECT_EQ(result.process_noise_scale.value_or(0), 1);
  }
}

}  // namespace
}  // namespace mmm_converter::s2kf
