// SPDX-License-Identifier: MIT
// The offline part of S2kfConverter: whole recordings, smoothed.
#include <algorithm>
#include <chrono>
#include <vector>

#include "plugins/s2kf/s2kf_converter.h"
#include "plugins/s2kf/trajectory_smoother.h"

namespace mmm_converter::s2kf {

namespace {

// So many frames keep their beliefs at a time (with rates 68 kB each); of the frames before, every
// so manieth is kept, and the filter runs once more from there.
constexpr int kChunk = 256;

}  // namespace

ConversionResult S2kfConverter::Convert(const MarkerSequence& recording,
                                        const KinematicModel& model,
                                        const std::vector<MarkerAssignment>& assignments,
                                        const std::function<bool(int)>& progress) {
  if (!settings_.smoothing) {
    return MotionConverter::Convert(recording, model, assignments, progress);
  }
  int first = -1;
  std::vector<TrackState> checkpoints;
  ConversionResult result = MotionConverter::Convert(recording, model, assignments, [&](int done) {
    if (first < 0) first = done - 1;
    if ((done - 1 - first) % kChunk == 0) {
      checkpoints.push_back(track_);
      checkpoints.back().random = search_.random();
      checkpoints.back().gate = gate_.state();
    }
    return !progress || progress(done);
  });
  Smooth(recording, first, checkpoints, &result);
  return result;
}

void S2kfConverter::Smooth(const MarkerSequence& recording, int first,
                           const std::vector<TrackState>& checkpoints, ConversionResult* result) {
  using Clock = std::chrono::steady_clock;
  const double dt = 1 / recording.rate();
  TrajectorySmoother smoother(filter_.motion_model(), filter_.transform(), settings_.root,
                              kinematics_.num_dofs());
  std::vector<Belief> filtered(kChunk);
  const int frames = recording.num_frames();
  for (int c = static_cast<int>(checkpoints.size()) - 1; c >= 0; --c) {
    const int begin = first + c * kChunk;
    const int end = std::min(begin + kChunk, frames);
    track_ = checkpoints[c];
    search_.random() = track_.random;
    gate_.set_state(track_.gate);
    filtered[0] = track_.belief;
    for (int k = begin + 1; k < end; ++k) {
      const Clock::time_point start = Clock::now();
      Track(recording.frame(k), dt);
      filtered[k - begin] = track_.belief;
      result->frames[k].seconds += std::chrono::duration<double>(Clock::now() - start).count();
    }
    for (int k = end - 1; k >= begin; --k) {
      const Clock::time_point start = Clock::now();
      if (k == frames - 1) {
        smoother.Start(filtered[k - begin]);
      } else {
        smoother.StepBack(filtered[k - begin], dt);
      }
      WriteSmoothed(recording, k, smoother.belief(), result);
      result->frames[k].seconds += std::chrono::duration<double>(Clock::now() - start).count();
    }
  }
  for (int k = 0; k < first; ++k) WriteSmoothed(recording, k, smoother.belief(), result);
}

void S2kfConverter::WriteSmoothed(const MarkerSequence& recording, int k, const Belief& belief,
                                  ConversionResult* result) {
  Gather(recording.frame(k));
  Posture& posture = result->trajectory.postures[k];
  filter_.ToPosture(belief, &posture);
  filter_.Deviations(belief, &deviations_);
  result->trajectory.standard_deviations.col(k) = deviations_;
  kinematics_.ComputeMarkers(posture.position, posture.orientation.toRotationMatrix(),
                             posture.joint_angles, &at_);
  result->residuals.col(k) = (measured_ - at_.p_WM).colwise().norm().transpose();
}

}  // namespace mmm_converter::s2kf
