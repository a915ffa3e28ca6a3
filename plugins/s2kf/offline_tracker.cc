// SPDX-License-Identifier: MIT
#include "plugins/s2kf/offline_tracker.h"

#include <algorithm>
#include <chrono>
#include <utility>

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

// The pass backwards is linear about the filter's track. Where that does not hold, its postures
// leave the markers, and it starts anew from the filter's: farther than so many times its distance
// and this [m].
constexpr double kMuchFarther = 1.5;
constexpr double kMuchFartherDistance = 0.01;

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
                               OnlineTracker* tracker)
    : recording_(recording),
      tracker_(*tracker),
      root_(settings.root),
      chunk_(settings.smoothing_chunk),
      clip_(FitOptions(settings).robust_distance),
      dt_(1 / recording.rate()),
      frame_(tracker->markers().kinematics()) {}

void OfflineTracker::Keep(int k, const TrackState& state) {
  if (!checkpoints_.empty() && k < checkpoints_.back().frame + chunk_) return;
  checkpoints_.push_back({k, state});
}

void OfflineTracker::Smooth(ConversionResult* result) {
  FindRetakes(*result);
  if (!retakes_.empty()) TrackFromRetakes();
  SmoothBackwards(result);
}

int OfflineTracker::Gather(int k) {
  return tracker_.markers().Gather(recording_.frame(k), &frame_.measured);
}

void OfflineTracker::FindRetakes(const ConversionResult& result) {
  MarkerFilter& filter = tracker_.filter();
  const int first = checkpoints_.front().frame;
  Belief belief;
  for (int k = recording_.num_frames() - 1; k > first; --k) {
    if (!result.frames[k].reassembled) continue;
    filter.StartAt(result.trajectory.postures[k], &belief);
    Gather(k);
    filter.Update(frame_.measured, &belief, &frame_.outcome);
    while (k > first) {
      if (Gather(k - 1) == 0) break;
      // The motion model is the same backwards.
      filter.Predict(dt_, &belief);
      filter.Update(frame_.measured, &belief, &frame_.outcome);
      const double before = ClippedMean(result.residuals.col(k - 1), clip_);
      if (MeasuredDistance(belief) > kNoFarther * before) break;
      --k;
      retakes_[k] = frame_.posture;
      retakes_.erase(k + 1);
      if (IsSamePosture(frame_.posture, result.trajectory.postures[k])) break;
    }
  }
}

void OfflineTracker::TrackFromRetakes() {
  while (checkpoints_.back().frame > retakes_.begin()->first) checkpoints_.pop_back();
  int k = checkpoints_.back().frame;
  TrackState state = std::move(checkpoints_.back().state);
  checkpoints_.pop_back();
  Retake(k, &state);
  Keep(k, state);
  for (++k; k < recording_.num_frames(); ++k) {
    TrackAgain(k, &state);
    Keep(k, state);
  }
}

void OfflineTracker::Retake(int k, TrackState* state) {
  const auto found = retakes_.find(k);
  if (found == retakes_.end()) return;
  Gather(k);
  tracker_.filter().StartAt(found->second, &state->belief);
  tracker_.filter().Update(frame_.measured, &state->belief, &frame_.outcome);
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
  std::vector<Belief> filtered(std::min(chunk_, frames));
  TrackState state;
  for (auto checkpoint = checkpoints_.rbegin(); checkpoint != checkpoints_.rend(); ++checkpoint) {
    const int begin = checkpoint->frame;
    const int end = std::min(begin + chunk_, frames);
    state = checkpoint->state;
    filtered[0] = state.belief;
    for (int k = begin + 1; k < end; ++k) {
      const Clock::time_point start = Clock::now();
      TrackAgain(k, &state);
      filtered[k - begin] = state.belief;
      result->frames[k].seconds += SecondsSince(start);
    }
    for (int k = end - 1; k >= begin; --k) {
      const Clock::time_point start = Clock::now();
      const Belief& of_filter = filtered[k - begin];
      if (k == frames - 1) {
        smoother.Start(of_filter);
      } else {
        smoother.StepBack(of_filter, dt_);
        Gather(k);
        if (!IsAsNear(smoother.belief(), of_filter)) smoother.Start(of_filter);
      }
      Write(k, smoother.belief(), result);
      result->frames[k].seconds += SecondsSince(start);
    }
  }
  const int first = checkpoints_.front().frame;
  for (int k = 0; k < first; ++k) Write(k, smoother.belief(), result);
}

bool OfflineTracker::IsAsNear(const Belief& smoothed, const Belief& filtered) {
  const double limit = kMuchFarther * MeasuredDistance(filtered) + kMuchFartherDistance;
  const bool is_near = MeasuredDistance(smoothed) <= limit;
  return is_near && frame_.posture.joint_angles.allFinite();
}

double OfflineTracker::MeasuredDistance(const Belief& belief) {
  tracker_.filter().Place(belief, &frame_.posture, &frame_.at);
  return ClippedMeanDistance(frame_.measured, frame_.at.p_WM, clip_);
}

void OfflineTracker::Write(int k, const Belief& belief, ConversionResult* result) {
  Gather(k);
  tracker_.filter().Place(belief, &frame_.posture, &frame_.at);
  tracker_.filter().Deviations(belief, &deviations_);
  result->trajectory.postures[k] = frame_.posture;
  result->trajectory.standard_deviations.col(k) = deviations_;
  result->residuals.col(k) = (frame_.measured - frame_.at.p_WM).colwise().norm().transpose();
}

}  // namespace mmm_converter::s2kf
