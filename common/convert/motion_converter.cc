// SPDX-License-Identifier: MIT
#include "common/convert/motion_converter.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "common/convert/checked_converter.h"
#include "common/model/posture.h"
#include "common/support/error.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

int CountSeen(const MarkerSequence& recording, const TrackingSetup& setup, int frame) {
  const auto points = recording.frame(frame);
  const std::vector<MarkerAssignment>& assignments = setup.assignments();
  return static_cast<int>(std::count_if(
      assignments.begin(), assignments.end(),
      [&](const MarkerAssignment& assignment) { return IsSeen(points.col(assignment.label)); }));
}

// The first frame in which a posture can be assembled: a third of the markers are seen, or, where
// that is not soon, as many as in any frame of the second after the first three. Who comes late is
// there in part at first.
int FindFirstFrame(const MarkerSequence& recording, const TrackingSetup& setup) {
  const int enough = std::max(kFewestMarkers, static_cast<int>(setup.assignments().size()) / 3);
  const int second = std::max(1, static_cast<int>(std::ceil(recording.rate())));
  int end = recording.num_frames();
  int best = -1, most = 0;
  for (int k = 0; k < end; ++k) {
    const int seen = CountSeen(recording, setup, k);
    if (seen <= most) continue;
    most = seen;
    if (seen < kFewestMarkers) continue;
    if (best < 0) end = std::min(end, k + second);
    best = k;
    if (seen >= enough) return k;
  }
  if (best >= 0) return best;
  throw Error(
      fmt::format("no frame shows {} mapped markers (at most {} of {} are seen); check the "
                  "marker mapping",
                  kFewestMarkers, most, setup.assignments().size()));
}

// Fills one frame of a result from what a converter says of it.
class ResultWriter {
 public:
  ResultWriter(const MarkerSequence& recording, const TrackingSetup& setup)
      : recording_(recording), setup_(setup) {
    const int frames = recording.num_frames();
    const int assignments = static_cast<int>(setup.assignments().size());
    const std::vector<int>& joints = setup.joints;
    PoseTrajectory& trajectory = result_.trajectory;
    trajectory.rate = recording.rate();
    trajectory.first_time = recording.first_time();
    for (const int joint : joints) trajectory.joint_names.push_back(setup.model->joint(joint).name);
    trajectory.postures.resize(frames);
    trajectory.standard_deviations.setConstant(6 + static_cast<int>(joints.size()), frames, kNaN);
    result_.residuals.setConstant(assignments, frames, kNaN);
    result_.frames.resize(frames);
    verdicts_.setConstant(assignments, frames, kAsLabelled);
  }

  void WritePosture(int k, const FrameEstimate& estimate) {
    Posture& posture = result_.trajectory.postures[k];
    posture.position = estimate.posture.position;
    posture.orientation = estimate.posture.orientation;
    posture.joint_angles = estimate.posture.joint_angles(setup_.joints);
    if (estimate.standard_deviations.size() > 0) {
      auto deviations = result_.trajectory.standard_deviations.col(k);
      deviations.head<6>() = estimate.standard_deviations.head<6>();
      const auto of_joints =
          estimate.standard_deviations.tail(estimate.standard_deviations.size() - 6);
      deviations.tail(static_cast<int>(setup_.joints.size())) = of_joints(setup_.joints);
    }
  }

  void Write(int k, const FrameEstimate& estimate, double seconds) {
    WritePosture(k, estimate);
    result_.residuals.col(k) = estimate.residuals;
    result_.frames[k] = {estimate.markers_seen,
                         estimate.markers_downweighted,
                         estimate.markers_wrong,
                         estimate.nis,
                         estimate.reassembled,
                         estimate.converged,
                         seconds};
    if (estimate.verdicts.size() > 0) verdicts_.col(k) = estimate.verdicts;
  }

  // Frames with too few markers to assemble take the first assembled posture, which is not theirs.
  void WriteEarlier(int first, const FrameEstimate& estimate) {
    for (int k = 0; k < first; ++k) {
      WritePosture(k, estimate);
      result_.frames[k].markers_seen = CountSeen(recording_, setup_, k);
    }
  }

  ConversionResult Finish() {
    result_.incidents = FindIncidents(verdicts_, BridgedFrames(recording_.rate()));
    return std::move(result_);
  }

 private:
  const MarkerSequence& recording_;
  const TrackingSetup& setup_;
  Eigen::MatrixXi verdicts_;  // assignments x frames
  ConversionResult result_;
};

}  // namespace

MotionConverter::MotionConverter(TrackingSetup setup) : setup_(std::move(setup)) {}
MotionConverter::~MotionConverter() = default;
void MotionConverter::Prepare(double /*dt*/) {}
bool MotionConverter::KeepCovariances() { return false; }
MotionConverterFactory::~MotionConverterFactory() = default;

ConversionResult MotionConverter::Convert(const MarkerSequence& recording,
                                          const std::function<bool(int)>& progress) {
  using Clock = std::chrono::steady_clock;
  const int first = FindFirstFrame(recording, setup_);
  const int frames = recording.num_frames();
  const double dt = 1 / recording.rate();
  ResultWriter writer(recording, setup_);
  for (int k = first; k < frames; ++k) {
    const Clock::time_point start = Clock::now();
    const FrameEstimate& estimate =
        k == first ? Assemble(recording.frame(k)) : Track(recording.frame(k), dt);
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    CheckEstimate(estimate, setup_);
    writer.Write(k, estimate, seconds);
    if (k == first) writer.WriteEarlier(first, estimate);
    if (progress && !progress(k + 1)) {
      throw Error(fmt::format("cancelled after {} of {} frames", k + 1, frames));
    }
  }
  return writer.Finish();
}

}  // namespace mmm_converter
