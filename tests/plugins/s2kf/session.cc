// SPDX-License-Identifier: MIT
#include "tests/plugins/s2kf/session.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <numbers>
#include <utility>

#include "common/calibrate/calibration.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/math/rotation.h"
#include "common/math/seeded_random.h"
#include "common/motion/marker_synthesis.h"
#include "common/motion/occlusion.h"
#include "common/motion/synthetic_motion.h"
#include "tests/plugins/s2kf/tracking_run.h"
#include "tests/support/shared_data.h"
#include "tests/support/synthetic_person.h"

namespace mmm_converter::s2kf {

namespace {

constexpr double kSessionHeight = 1.8;  // [m]
constexpr double kHiddenShare = 0.1;
constexpr double kHiddenFrames = 30;  // of a block, in the mean
constexpr double kCalibrationSeconds = 40;
constexpr double kRangeShare = 0.7;  // of each joint
// Without the side.
constexpr const char* kArmMarkers[] = {"UPA", "AEL", "AOL", "FRA", "WTS",
                                       "WPS", "HTS", "HPS", "IFD"};
constexpr const char* kLegMarkers[] = {"THI", "KNE", "TIP", "ANK", "HEE", "TOE", "MT1", "MT5"};

PoseTrajectory Recorded(const std::string& file) {
  return LowPassed(
      ReadMmmMotionFile(testing::SharedData("mmm/motions_legacy/" + file)).motions[0].trajectory);
}

/// The right arm up, its shoulder and elbow swinging, all else nearly still.
PoseTrajectory MakeWaving(const KinematicModel& model, int frames, std::uint64_t seed) {
  SeededRandom random(seed);
  const std::map<std::string, double> raised = {
      {"RSx_joint", 0.6}, {"RSy_joint", -0.5}, {"REx_joint", 1.4}, {"LSx_joint", 0.1},
      {"LEx_joint", 0.2}, {"RKx_joint", -0.1}, {"LKx_joint", -0.1}};
  const std::map<std::string, double> swing = {
      {"RSz_joint", 0.5}, {"REx_joint", 0.4}, {"RWy_joint", 0.3}, {"REz_joint", 0.3}};
  const double rate = 1.2 + 0.8 * random.Uniform();  // [Hz]
  PoseTrajectory motion;
  motion.rate = 100;
  std::vector<double> phase;
  for (const int joint : testing::TrackedJoints(model)) {
    motion.joint_names.push_back(model.joint(joint).name);
    phase.push_back(2 * std::numbers::pi * random.Uniform());
  }
  for (int k = 0; k < frames; ++k) {
    const double t = k / motion.rate;
    Posture q;
    q.position = Eigen::Vector3d(0.02 * std::sin(0.8 * t), 0.02 * std::sin(1.1 * t), 1);
    q.orientation = Exp(Eigen::Vector3d(0.03 * std::sin(t), 0.03 * std::sin(0.7 * t), 0.5));
    q.joint_angles.resize(static_cast<Eigen::Index>(phase.size()));
    for (std::size_t j = 0; j < phase.size(); ++j) {
      const std::string& name = motion.joint_names[j];
      const auto up = raised.find(name);
      const auto swings = swing.find(name);
      const bool waves = swings != swing.end();
      const Segment& joint = model.joint(model.FindJoint(name));
      const double angle = (up == raised.end() ? 0 : up->second) +
                           (waves ? swings->second : 0.05) *
                               std::sin(2 * std::numbers::pi * (waves ? rate : 0.3) * t + phase[j]);
      q.joint_angles[static_cast<Eigen::Index>(j)] = std::clamp(angle, joint.lower, joint.upper);
    }
    motion.postures.push_back(q);
  }
  return motion;
}

}  // namespace

std::vector<NamedMotion> SessionMotions(const KinematicModel& model, int frames,
                                        std::uint64_t seed) {
  std::vector<NamedMotion> motions;
  if (std::filesystem::exists(testing::SharedData("mmm/motions_legacy"))) {
    motions.push_back({"walking", Recorded("walking_medium01_motion395.xml")});
    motions.push_back({"quick motion", Recorded("test_mmm_subject314_40joints_100Hz.xml")});
  }
  motions.push_back(
      {"range of motion", testing::RangeOfMotion(model, frames / 100.0, kRangeShare, seed + 500)});
  motions.push_back({"waving", MakeWaving(model, frames, seed)});
  motions.push_back({"cartwheel", MakeCartwheel(model)});
  for (NamedMotion& named : motions) {
    std::vector<Posture>& postures = named.motion.postures;
    postures.resize(std::min<std::size_t>(postures.size(), frames));
  }
  return motions;
}

Session::Session(std::uint64_t number)
    : seed(number),
      model(testing::ScaledReferenceModel(kSessionHeight)),
      person(FitToSubject(
          model, testing::DrawPerson(model, seed,
                                     0.020 + 0.008 * SeededRandom(seed + 1000000).Uniform()))),
      joints(testing::TrackedJoints(model)) {}

MarkerSequence Session::Record(const PoseTrajectory& motion) const {
  MarkerErrors errors;
  errors.offset = 0;
  errors.wobble = 0.004;
  errors.wobble_time_constant = 0.3;
  errors.noise = 0.0005;
  return SynthesizeMarkers(person, motion, errors, seed);
}

KinematicModel Session::Calibrate() const {
  const MarkerSequence trial =
      Record(testing::RangeOfMotion(model, kCalibrationSeconds, kRangeShare, seed));
  const CalibrationRecording recording = {"trial", &trial, AssignAll(model, trial)};
  return FitToSubject(model, CalibrateSubject(model, joints, {recording}, {}).subject);
}

MarkerSequence HideBlocks(const MarkerSequence& recording, std::uint64_t seed) {
  return OccludeShare(recording, kHiddenShare, kHiddenFrames, seed);
}

std::vector<std::string> RightArm() {
  std::vector<std::string> labels;
  for (const char* name : kArmMarkers) labels.push_back(std::string("R") + name);
  return labels;
}

MarkerSequence SwapSides(MarkerSequence recording, Limb limb, int begin, int end) {
  const auto swap = [&](const std::string& name) {
    recording = SwapMarkers(std::move(recording), "L" + name, "R" + name, begin, end);
  };
  if (limb == Limb::kArm) {
    std::for_each(std::begin(kArmMarkers), std::end(kArmMarkers), swap);
  } else {
    std::for_each(std::begin(kLegMarkers), std::end(kLegMarkers), swap);
  }
  return recording;
}

}  // namespace mmm_converter::s2kf
