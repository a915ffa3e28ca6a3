// SPDX-License-Identifier: MIT
#include "common/convert/tracking_start.h"

#include <algorithm>
#include <chrono>

#include "common/convert/marker_incidents.h"
#include "common/convert/tracked_joints.h"
#include "common/model/posture.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr double kPatience = 1;     // [s]
constexpr double kRounding = 1e-6;  // [s]

// Whether three markers are where the posture has them.
bool IsTracked(const FrameEstimate& estimate) {
  return estimate.converged && !estimate.reassembled &&
         estimate.markers_seen - estimate.markers_wrong >= kFewestMarkers;
}

}  // namespace

int CountSeen(const Eigen::Ref<const Eigen::Matrix3Xd>& frame, const TrackingSetup& setup) {
  const std::vector<MarkerAssignment>& assignments = setup.assignments();
  return static_cast<int>(
      std::count_if(assignments.begin(), assignments.end(),
                    [&](const MarkerAssignment& one) { return IsSeen(frame.col(one.label)); }));
}

TrackingStart::TrackingStart(const TrackingSetup& setup)
    : enough_(std::max(kFewestMarkers, static_cast<int>(setup.assignments().size()) / 3)) {}

bool TrackingStart::IsAt(double time, int seen) {
  if (seen >= enough_) return true;
  if (seen < kFewestMarkers) return false;
  while (!most_.empty() && most_.front().first < time - kPatience - kRounding) most_.pop_front();
  while (!most_.empty() && most_.back().first > time) most_.pop_back();
  if (most_.empty()) since_ = time;
  const bool shows_most = most_.empty() || most_.front().second <= seen;
  while (!most_.empty() && most_.back().second <= seen) most_.pop_back();
  most_.emplace_back(time, seen);
  return shows_most && time - since_ > kPatience - kRounding;
}

int TrackBackward(const MarkerSequence& recording, int first, int earliest,
                  MotionConverter* converter,
                  const std::function<void(int, const FrameEstimate&, double)>& write) {
  using Clock = std::chrono::steady_clock;
  if (earliest < first) converter->Assemble(recording.frame(first));
  for (; first > earliest; --first) {
    const Clock::time_point start = Clock::now();
    const FrameEstimate& estimate =
        converter->Track(recording.frame(first - 1), 1 / recording.rate());
    if (!IsTracked(estimate)) break;
    write(first - 1, estimate, std::chrono::duration<double>(Clock::now() - start).count());
  }
  return first;
}

ResultWriter::ResultWriter(const MarkerSequence& recording, const TrackingSetup& setup,
                           Eigen::MatrixXi* verdicts, ConversionResult* result)
    : recording_(recording), setup_(setup), verdicts_(*verdicts), result_(*result) {}

void ResultWriter::Clear() {
  const int frames = recording_.num_frames();
  const auto assignments = static_cast<Eigen::Index>(setup_.assignments().size());
  PoseTrajectory& trajectory = result_.trajectory;
  trajectory.rate = recording_.rate();
  trajectory.first_time = recording_.first_time();
  trajectory.joint_names = TrackedJoints(setup_);
  trajectory.postures.resize(static_cast<std::size_t>(frames));
  trajectory.standard_deviations.setConstant(6 + static_cast<Eigen::Index>(setup_.joints.size()),
                                             frames, kNaN);
  result_.residuals.setConstant(assignments, frames, kNaN);
  result_.frames.resize(static_cast<std::size_t>(frames));
  verdicts_.setConstant(assignments, frames, kAsLabelled);
}

void ResultWriter::Write(int k, const FrameEstimate& estimate, double seconds) {
  PoseTrajectory& trajectory = result_.trajectory;
  TakeTracked(setup_, estimate, &trajectory.postures[static_cast<std::size_t>(k)],
              trajectory.standard_deviations.col(k));
  result_.residuals.col(k) = estimate.residuals;
  result_.frames[static_cast<std::size_t>(k)] = {estimate.markers_seen,
                                                 estimate.markers_downweighted,
                                                 estimate.markers_wrong,
                                                 estimate.nis,
                                                 estimate.reassembled,
                                                 estimate.converged,
                                                 seconds};
  if (estimate.verdicts.size() > 0) verdicts_.col(k) = estimate.verdicts;
}

void ResultWriter::WriteEarlier(int first) {
  PoseTrajectory& trajectory = result_.trajectory;
  for (int k = 0; k < first; ++k) {
    trajectory.postures[static_cast<std::size_t>(k)] =
        trajectory.postures[static_cast<std::size_t>(first)];
    trajectory.standard_deviations.col(k) = trajectory.standard_deviations.col(first);
    result_.frames[static_cast<std::size_t>(k)].markers_seen =
        CountSeen(recording_.frame(k), setup_);
  }
}

void ResultWriter::FindIncidents() {
  result_.incidents = mmm_converter::FindIncidents(verdicts_, BridgedFrames(recording_.rate()));
}

}  // namespace mmm_converter
