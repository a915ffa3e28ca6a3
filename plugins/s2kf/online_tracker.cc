// SPDX-License-Identifier: MIT
#include "plugins/s2kf/online_tracker.h"

#include <string>

#include "common/model/posture.h"
#include "common/support/error.h"

namespace mmm_converter::s2kf {

using Eigen::Matrix3Xd;
using Eigen::Ref;

namespace {

/// The motion model that fits these markers. Of landmarks a random walk lags: ankles of walking
/// persons lose a third of their range, and when quicker, it is lost in dances.
S2kfSettings Settle(S2kfSettings settings, const TrackedMarkers& markers) {
  if (settings.motion_model != MotionModelType::kAuto) return settings;
  settings.motion_model = MotionModelType::kRandomWalk;
  if (markers.MeanTrust() <= 1) return settings;
  settings.motion_model = MotionModelType::kVelocity;
  settings.velocity_noise = {1, 5, 10};
  settings.natural_spread = 0.35;
  settings.velocity_decay = 1;
  return settings;
}

}  // namespace

OnlineTracker::OnlineTracker(const TrackedMarkers& markers, const S2kfSettings& settings)
    : markers_(markers),
      settings_(Settle(settings, markers)),
      clip_(FitOptions(settings).robust_distance),
      filter_(markers.kinematics(), settings_, markers.FilterScale(settings.marker_deviation),
              markers.pulls()),
      update_(markers, settings.gate_probability),
      watch_(markers.UsualDeviation(settings.marker_deviation), settings.smoothing),
      recovery_(markers, settings) {
  candidate_.joint_angles.setZero(markers.kinematics().num_joints());
  held_ = candidate_;
}

double OnlineTracker::Distance(const TrackedFrame& frame) const {
  return ClippedMeanDistance(frame.z, frame.at.p_WM, clip_);
}

void OnlineTracker::Start(const Ref<const Matrix3Xd>& points, TrackState* state,
                          TrackedFrame* frame) {
  frame->seen = markers_.Gather(points, &frame->measured);
  if (frame->seen < kFewestMarkers) {
    throw Error("only " + std::to_string(frame->seen) +
                " of the mapped markers are seen in the first frame; at least 3 are needed");
  }
  const int num_markers = markers_.kinematics().num_markers();
  *state = TrackState();
  state->gate.Start(markers_.skin_deviation());
  if (settings_.start == StartMethod::kPaper) {
    filter_.StartAsPaper(frame->measured, &state->belief);
  } else {
    recovery_.Assemble(*frame, &state->random, &candidate_);
    filter_.StartAt(candidate_, &state->belief);
  }
  Update(state, frame);
  frame->reassembled = false;
  watch_.Start(num_markers, Distance(*frame), &state->watch);
}

void OnlineTracker::Step(const Ref<const Matrix3Xd>& points, double dt, TrackState* state,
                         TrackedFrame* frame) {
  frame->seen = markers_.Gather(points, &frame->measured);
  StepTo(dt, state, frame);
}

void OnlineTracker::StepTo(double dt, TrackState* state, TrackedFrame* frame) {
  filter_.Predict(dt, &state->belief);
  state->gate.Advance(dt);
  Update(state, frame);
}

void OnlineTracker::Prepare(double dt, const TrackState& state) {
  prepared_ = state.belief;
  filter_.Predict(dt, &prepared_);
  filter_.Prepare(prepared_);
}

void OnlineTracker::TakeUp(const Posture& posture, TrackState* state, TrackedFrame* frame) {
  filter_.StartAt(posture, &state->belief);
  state->gate.Loosen();
  Update(state, frame);
}

void OnlineTracker::Track(const Ref<const Matrix3Xd>& points, double dt, TrackState* state,
                          TrackedFrame* frame) {
  frame->seen = markers_.Gather(points, &frame->measured);
  state->gate.Select(frame->measured, &frame->relabelled, &frame->z);
  const bool finds_again = settings_.recovery && !settings_.smoothing;
  if (finds_again && watch_.IsBack(frame->z, dt, state->watch)) {
    Return(dt, state, frame);
    watch_.IsInDoubt(frame->z, Distance(*frame), dt, &state->watch);
    return;
  }
  StepTo(dt, state, frame);
  frame->reassembled = settings_.recovery && Reopen(state, frame);
  if (!settings_.recovery) return;
  if (frame->seen < kFewestMarkers) {
    watch_.TakeHidden(frame->z, dt, &state->watch);
    return;
  }
  const bool is_in_doubt = watch_.IsInDoubt(frame->z, Distance(*frame), dt, &state->watch);
  if (is_in_doubt && !frame->reassembled) frame->reassembled = Recover(state, frame);
}

void OnlineTracker::Return(double dt, TrackState* state, TrackedFrame* frame) {
  filter_.ToPosture(state->belief, &held_);
  recovery_.FindAgain(*frame, held_, watch_, &state->random, &candidate_);
  state->gate.Advance(dt);
  TakeUp(candidate_, state, frame);
  frame->reassembled = true;
}

bool OnlineTracker::Reopen(TrackState* state, TrackedFrame* frame) {
  const int left_out = state->gate.CountLeftOut(frame->measured);
  if (!recovery_.FindForAll(*frame, left_out, watch_, &candidate_)) return false;
  state->gate.Open();
  TakeUp(candidate_, state, frame);
  return true;
}

bool OnlineTracker::Recover(TrackState* state, TrackedFrame* frame) {
  if (!recovery_.FindBetter(*frame, watch_, &state->random, &candidate_)) return false;
  TakeUp(candidate_, state, frame);
  watch_.Recovered(Distance(*frame), &state->watch);
  return true;
}

}  // namespace mmm_converter::s2kf
