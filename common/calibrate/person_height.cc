// SPDX-License-Identifier: MIT
#include "common/calibrate/person_height.h"

#include <cmath>
#include <utility>
#include <vector>

#include "common/calibrate/body_fit.h"
#include "common/fit/posture_search.h"
#include "common/model/model_scaling.h"

namespace mmm_converter {
namespace {

constexpr int kFrames = 24;
constexpr int kLeastHeightMarkers = 10;
constexpr int kAttempts = 4;
constexpr double kAnyMass = 70;  // [kg]; Winter's scaling wants one, no length depends on it

// Lengths of persons are some 3 % off Winter's (uniform in +-5 %), the same left and right; markers
// sit 2 to 3 cm off. The height of a first guess may be wrong by far. Skin is given more than a
// calibration gives it: as that has it, synthetic persons are estimated better (14 in place of 16
// mm in a range of motion), real ones worse (of 1.79 m: 1.72 in place of 1.76).
CalibrationOptions Options() {
  CalibrationOptions options;
  options.marker_deviation = 0.026;
  options.scale_deviation = 0.03;
  options.side_deviation = 0.005;
  options.skin_deviation = 0.02;
  options.height_deviation = 0.2;
  return options;
}

// Of each part of the recording the frame in its middle, or the next one that shows enough.
std::vector<CalibrationFrame> ChooseFrames(const TrackingSetup& setup,
                                           const MarkerSequence& recording) {
  const std::vector<LabelIx> labels = LabelIndices(setup.assignments());
  std::vector<CalibrationFrame> frames;
  const long n = recording.num_frames();
  for (int part = 0; part < kFrames; ++part) {
    const int end = static_cast<int>(n * (part + 1) / kFrames);
    for (int k = static_cast<int>(n * (2 * part + 1) / (2 * kFrames)); k < end; ++k) {
      CalibrationFrame frame;
      frame.frame = k;
      frame.time = k / recording.rate();
      frame.z = recording.frame(k)(Eigen::all, labels);
      if (frame.z.row(0).array().isFinite().count() < kLeastHeightMarkers) continue;
      frames.push_back(std::move(frame));
      break;
    }
  }
  return frames;
}

void FindPostures(const MarkerKinematics& kinematics, std::vector<CalibrationFrame>* frames) {
  const Eigen::VectorXd scale = Eigen::VectorXd::Ones(kinematics.num_markers());
  PostureFitOptions options;
  options.robust_distance = 0.1;
  PostureSearch search(kinematics);
  for (CalibrationFrame& frame : *frames) {
    search.Assemble(frame.z, scale, options, kAttempts, &frame.posture);
  }
}

}  // namespace

PersonHeight EstimatePersonHeight(const TrackingSetup& setup, const MarkerSequence& recording,
                                  bool with_ordinary_height) {
  HeightOptions how;
  how.with_ordinary_height = with_ordinary_height;
  if (with_ordinary_height) how.noise_scale = NoiseScales(setup.assignments());
  const HeightEstimate guess =
      EstimateHeight(*setup.model, setup.joints, MarkerIndices(setup.assignments()),
                     LabelIndices(setup.assignments()), recording, how);
  std::vector<CalibrationFrame> frames = ChooseFrames(setup, recording);
  CalibrationOptions options = Options();
  if (frames.empty()) return {guess.height, guess.deviation, guess.frames};
  if (with_ordinary_height) options.height_deviation = kHeightDeviation;
  options.places_by_noise = with_ordinary_height;
  const KinematicModel scaled = ScaleWinter(*setup.model, {guess.height, kAnyMass, {}});
  BodyKinematics kinematics(scaled, setup.joints, MarkerIndices(setup.assignments()));
  FindPostures(kinematics.kinematics(), &frames);
  Body body = kinematics.ModelBody();
  const BodyFitResult fit =
      FitBody(&kinematics, options, NoiseScales(setup.assignments()), &frames, &body);
  return {guess.height * (1 + fit.common_scale), guess.height * fit.common_deviation,
          static_cast<int>(frames.size())};
}

}  // namespace mmm_converter
