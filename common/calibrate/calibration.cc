// SPDX-License-Identifier: MIT
#include "common/calibrate/calibration.h"

#include <fmt/format.h>

#include "common/calibrate/body_fit.h"
#include "common/calibrate/body_kinematics.h"
#include "common/calibrate/calibration_frames.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {
constexpr int kLeastFrames = 20;
}  // namespace

CalibrationResult CalibrateSubject(const KinematicModel& model, const std::vector<int>& joints,
                                   const std::vector<CalibrationRecording>& recordings,
                                   const CalibrationOptions& options) {
  const std::vector<int> markers = UsedMarkers(recordings);
  std::vector<CalibrationFrame> frames =
      CandidateFrames(recordings, markers, static_cast<int>(markers.size()) * 3 / 5);
  if (static_cast<int>(frames.size()) < kLeastFrames) throw Error("too short");
  BodyKinematics kinematics(model, joints, markers);
  Body body = kinematics.ModelBody();
  Eigen::VectorXd before;
  Eigen::VectorXd after;
  body.offsets = FitOffsetsInTurns(model, joints, markers, &frames, &before, &after);
  CalibrationResult result;
  result.distance_before = before.mean();
  result.distance_after = after.mean();
  std::vector<CalibrationFrame> chosen = ChooseFrames(std::move(frames), after, options.frames);
  const BodyFitResult fit =
      FitBody(&kinematics, options,
              Eigen::VectorXd::Ones(static_cast<Eigen::Index>(markers.size())), &chosen, &body);
  result.frames = static_cast<int>(chosen.size());
  result.iterations = fit.iterations;
  const SegmentLengths& lengths = kinematics.lengths();
  for (std::size_t i = 0; i < lengths.segments.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    result.subject.scales.push_back({model.segments()[lengths.segments[i]].name, body.scales[k],
                                     fit.deviations.scales[k], options.scale_deviation});
  }
  for (std::size_t m = 0; m < markers.size(); ++m) {
    const auto k = static_cast<Eigen::Index>(m);
    MarkerOffset offset;
    offset.marker = model.markers()[markers[m]].name;
    offset.offset = body.offsets.col(k);
    offset.standard_deviations = fit.deviations.offsets.col(k);
    offset.prior_deviation = options.marker_deviation;
    result.subject.offsets.push_back(offset);
  }
  fmt::print(
      "{} candidates, {} frames, {} it, cost {}, converged {}, before {:.2f} turns {:.2f} mm\n",
      after.size(), result.frames, fit.iterations, fit.cost, fit.converged,
      1000 * result.distance_before, 1000 * result.distance_after);
  return result;
}

}  // namespace mmm_converter
