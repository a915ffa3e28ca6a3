// SPDX-License-Identifier: MIT
#include "plugins/s2kf/offline_tracker.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "common/support/units.h"
#include "plugins/s2kf/correlation_log.h"
#include "plugins/s2kf/trajectory_smoother.h"

namespace mmm_converter::s2kf {

namespace {

using Clock = std::chrono::steady_clock;

// Going backwards from a posture that was found later goes on while it is no farther from the
// markers than this share beyond the track, and ends where the root and all joint angles differ by
// less.
constexpr double kNoFarther = 1.02;
constexpr double kSameAngle = 0.02;  // [rad]
constexpr double kSamePlace = 0.01;  // [m]

// The pass backwards is linear about the filter's track. Where that does not hold, a marker leaves
// its place, and the pass starts anew from the filter's belief: farther than with the filter by
// this [m].
constexpr double kMuchFarther = 0.03;

constexpr double kNeverAgain = 1e3;  // [s]

bool IsSamePosture(const Posture& a, const Posture& b) {
  const auto apart = (a.joint_angles - b.joint_angles).array().abs();
  return (a.position - b.position).norm() < kSamePlace &&
         a.orientation.angularDistance(b.orientation) < kSameAngle && (apart < kSameAngle).all();
}

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

OfflineTracker::OfflineTracker(const MarkerSequence& recording, const S2kfSettings& settings,
                               const TrackedMarkers& markers, OnlineTracker* tracker)
    : recording_(recording),
      markers_(markers),
      tracker_(*tracker),
      root_(settings.root),
      chunk_(settings.smoothing_chunk),
      clip_(FitOptions(settings).robust_distance),
      dt_(1 / recording.rate()),
      distances_(recording.num_frames()),
      filtered_(std::min(chunk_, recording.num_frames())),
      used_(filtered_.size(), Eigen::Matrix3Xd(3, tracker->markers().kinematics().num_markers())),
      frame_(tracker->markers().kinematics()),
      of_model_(markers.kinematics().MakeJacobian()),
      covariance_(markers, settings) {
  verdicts_.setConstant(tracker->markers().kinematics().num_markers(), recording.num_frames(),
                        kAsLabelled);
}

void OfflineTracker::Keep(int k, const TrackState& state, const TrackedFrame& frame) {
  KeepState(k, state);
  distances_[k] = tracker_.DistanceOfAll(frame);
  if (frame.reassembled) reassembled_[k] = state.gate;
}

void OfflineTracker::KeepState(int k, const TrackState& state) {
  if (checkpoints_.empty() || k >= checkpoints_.back().frame + chunk_) {
    checkpoints_.push_back({k, state});
  }
  KeepBelief(k - checkpoints_.back().frame, k, state);
}

void OfflineTracker::KeepBelief(int i, int k, const TrackState& state) {
  filtered_[i] = state.belief;
  Gather(k);
  state.gate.Select(frame_.measured, &frame_.relabelled, &used_[i]);
  verdicts_.col(k) = state.gate.verdicts.cast<std::int16_t>();
}

void OfflineTracker::Smooth(bool keeps_covariances, ConversionResult* result) {
  FindRetakes(*result);
  if (!retakes_.empty()) TrackFromRetakes();
  SmoothBackwards(result);
  ReportDeviations(keeps_covariances, result);
}

void OfflineTracker::Gather(int k) {
  tracker_.markers().Gather(recording_.frame(k), &frame_.measured);
}

void OfflineTracker::FindRetakes(const ConversionResult& result) {
  const int first = checkpoints_.front().frame;
  TrackState state;
  int done = recording_.num_frames();
  for (auto found = reassembled_.rbegin(); found != reassembled_.rend(); ++found) {
    int k = found->first;
    if (k >= done) continue;
    state.gate = found->second;
    tracker_.filter().StartAt(result.trajectory.postures[k], &state.belief);
    for (; k > first; --k) {
      // The motion model is the same backwards.
      tracker_.Step(recording_.frame(k - 1), dt_, &state, &frame_);
      if (frame_.outcome.seen == 0) break;
      if (tracker_.DistanceOfAll(frame_) > kNoFarther * distances_[k - 1]) break;
      retakes_.erase(k);
      retakes_[k - 1] = frame_.posture;
      if (IsSamePosture(frame_.posture, result.trajectory.postures[k - 1])) break;
    }
    done = k;
  }
}

void OfflineTracker::TrackFromRetakes() {
  while (checkpoints_.back().frame > retakes_.begin()->first) checkpoints_.pop_back();
  int k = checkpoints_.back().frame;
  TrackState state = std::move(checkpoints_.back().state);
  checkpoints_.pop_back();
  Retake(k, &state);
  KeepState(k, state);
  for (++k; k < recording_.num_frames(); ++k) {
    TrackAgain(k, &state);
    KeepState(k, state);
  }
}

void OfflineTracker::Retake(int k, TrackState* state) {
  const auto found = retakes_.find(k);
  if (found == retakes_.end()) return;
  Gather(k);
  tracker_.TakeUp(found->second, state, &frame_);
}

void OfflineTracker::TrackAgain(int k, TrackState* state) {
  tracker_.Track(recording_.frame(k), dt_, state, &frame_);
  Retake(k, state);
}

void OfflineTracker::SmoothBackwards(ConversionResult* result) {
  const MarkerFilter& filter = tracker_.filter();
  const int frames = recording_.num_frames();
  TrajectorySmoother smoother(filter.motion_model(), filter.transform(), root_,
                              tracker_.markers().kinematics().num_dofs());
  TrackState state;
  Belief estimate;
  for (auto checkpoint = checkpoints_.rbegin(); checkpoint != checkpoints_.rend(); ++checkpoint) {
    const int begin = checkpoint->frame;
    const int end = std::min(begin + chunk_, frames);
    // The beliefs of the last part are still there.
    if (checkpoint != checkpoints_.rbegin()) {
      state = checkpoint->state;
      for (int k = begin; k < end; ++k) {
        const Clock::time_point start = Clock::now();
        if (k > begin) TrackAgain(k, &state);
        KeepBelief(k - begin, k, state);
        result->frames[k].seconds += SecondsSince(start);
      }
    }
    for (int k = end - 1; k >= begin; --k) {
      const Clock::time_point start = Clock::now();
      const Belief& of_filter = filtered_[k - begin];
      if (k == frames - 1) {
        smoother.Start(of_filter);
        estimate = of_filter;
      } else {
        smoother.StepBack(of_filter, dt_);
        smoother.EstimateAbout(of_filter, &estimate);
        if (!IsAsNear(used_[k - begin], estimate, of_filter)) {
          smoother.Start(of_filter);
          estimate = of_filter;
        }
      }
      TakeEstimate(estimate, &estimate_);
      Write(k, estimate_, result);
      result->frames[k].seconds += SecondsSince(start);
    }
  }
  const int first = checkpoints_.front().frame;
  int begin = first;
  for (const Estimate& earlier : earlier_) Write(--begin, earlier, result);
  const Estimate& earliest = earlier_.empty() ? estimate_ : earlier_.back();
  for (int k = 0; k < begin; ++k) {
    Write(k, earliest, result);
    result->residuals.col(k).setConstant(kNaN);  // the posture is not of this frame
  }
}

bool OfflineTracker::IsAsNear(const Eigen::Matrix3Xd& z, const Belief& smoothed,
                              const Belief& filtered) {
  tracker_.filter().Place(filtered, &frame_.posture, &frame_.at);
  distances_of_filter_ = (z - frame_.at.p_WM).colwise().norm();
  tracker_.filter().Place(smoothed, &frame_.posture, &frame_.at);
  for (int m = 0; m < z.cols(); ++m) {
    const double distance = (z.col(m) - frame_.at.p_WM.col(m)).norm();
    if (distance > distances_of_filter_[m] + kMuchFarther) return false;
  }
  return frame_.posture.joint_angles.allFinite();
}

void OfflineTracker::PlaceByModel(const Posture& q) {
  markers_.kinematics().ComputeMarkers(q.position, q.orientation.toRotationMatrix(), q.joint_angles,
                                       &of_model_);
}

void OfflineTracker::KeepEarlier(const TrackState& state) {
  TakeEstimate(state.belief, &earlier_.emplace_back());
}

void OfflineTracker::TakeEstimate(const Belief& belief, Estimate* estimate) const {
  tracker_.filter().ToPosture(belief, &estimate->posture);
  tracker_.filter().Deviations(belief, &estimate->deviations);
}

void OfflineTracker::Write(int k, const Estimate& estimate, ConversionResult* result) {
  Gather(k);
  result->trajectory.postures[k] = estimate.posture;
  result->trajectory.standard_deviations.col(k) = estimate.deviations;
  PlaceByModel(estimate.posture);
  result->residuals.col(k) = (frame_.measured - of_model_.p_WM).colwise().norm().transpose();
}

void OfflineTracker::ReportDeviations(bool keeps_covariances, ConversionResult* result) {
  const int frames = recording_.num_frames();
  const Eigen::Index markers = result->residuals.rows();
  Eigen::MatrixXd& deviations = result->trajectory.standard_deviations;
  const auto is_used = [&](Eigen::Index m, int k) {
    const int verdict = verdicts_(m, k);
    if (verdict == kAsLabelled) return result->residuals(m, k) <= clip_;
    return verdict != m && std::isfinite(result->residuals(verdict, k));
  };
  std::vector<int> next(markers, 0);  // frame in which each marker is used, k or later
  Eigen::VectorXd until(markers);     // that [s]
  GateState gate;
  covariance_.Restart();
  CorrelationLog correlations(recording_);
  for (int k = 0; k < frames; ++k) {
    const Clock::time_point start = Clock::now();
    for (Eigen::Index m = 0; m < markers; ++m) {
      int& look = next[m];
      look = std::max(look, k);
      while (look < frames && !is_used(m, look)) ++look;
      until[m] = look < frames ? (look - k) * dt_ : kNeverAgain;
    }
    Gather(k);
    gate.verdicts = verdicts_.col(k).cast<int>();
    gate.Select(frame_.measured, &frame_.relabelled, &frame_.z);
    const Posture& q = result->trajectory.postures[k];
    PlaceByModel(q);
    covariance_.Look(frame_.z, of_model_, dt_);
    if (covariance_.IsDue()) {
      own_deviations_ = deviations.col(k);
      covariance_.Compute(q.joint_angles, own_deviations_, &of_model_, &until);
      if (keeps_covariances) result->covariances.push_back({k, covariance_.Covariance()});
      if (correlations.IsDue(k)) correlations.Keep(k, covariance_.Covariance());
    }
    deviations.col(k) = covariance_.deviations();
    result->frames[k].seconds += SecondsSince(start);
  }
  result->trajectory.correlations = correlations.Take();
}

}  // namespace mmm_converter::s2kf
