// SPDX-License-Identifier: MIT
#include "tests/plugins/s2kf/session.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "common/calibrate/calibration.h"
#include "common/math/seeded_random.h"
#include "common/motion/marker_synthesis.h"
#include "tests/plugins/s2kf/session_motions.h"
#include "tests/support/changed_markers.h"
#include "tests/support/synthetic_person.h"

namespace mmm_converter::s2kf {

namespace {

constexpr double kSessionHeight = 1.8;  // [m]
constexpr double kHiddenShare = 0.1;
constexpr double kHiddenFrames = 30;  // of a block, in the mean
constexpr double kCalibrationSeconds = 40;
// Without the side.
constexpr const char* kArmMarkers[] = {"UPA", "AEL", "AOL", "FRA", "WTS",
                                       "WPS", "HTS", "HPS", "IFD"};
constexpr const char* kLegMarkers[] = {"THI", "KNE", "TIP", "ANK", "HEE", "TOE", "MT1", "MT5"};

}  // namespace

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
  const CalibrationRecording recording = {"trial", &trial, testing::AssignAll(model, trial)};
  return FitToSubject(model, CalibrateSubject(model, joints, {recording}, {}).subject);
}

MarkerSequence HideBlocks(const MarkerSequence& recording, std::uint64_t seed) {
  return testing::OccludeShare(recording, kHiddenShare, kHiddenFrames, seed);
}

std::vector<std::string> RightArm() {
  std::vector<std::string> labels;
  for (const char* name : kArmMarkers) labels.push_back(std::string("R") + name);
  return labels;
}

MarkerSequence SwapSides(MarkerSequence recording, Limb limb, int begin, int end) {
  const auto swap = [&](const std::string& name) {
    recording = testing::SwapMarkers(std::move(recording), "L" + name, "R" + name, begin, end);
  };
  if (limb == Limb::kArm) {
    std::for_each(std::begin(kArmMarkers), std::end(kArmMarkers), swap);
  } else {
    std::for_each(std::begin(kLegMarkers), std::end(kLegMarkers), swap);
  }
  return recording;
}

}  // namespace mmm_converter::s2kf
