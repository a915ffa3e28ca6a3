// SPDX-License-Identifier: MIT
// The offline part of S2kfConverter: whole recordings, smoothed.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "common/motion/trajectory_derivatives.h"
#include "plugins/s2kf/process_noise_scale.h"
#include "plugins/s2kf/s2kf_converter.h"
#include "plugins/s2kf/trajectory_smoother.h"

namespace mmm_converter::s2kf {

using Eigen::VectorXd;

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

ConversionResult S2kfConverter::Convert(const MarkerSequence& recording,
                                        const std::function<bool(int)>& progress) {
  if (settings_.choose_process_noise_scale) {
    S2kfSettings settings = settings_;
    const double scale = ChooseProcessNoiseScale(recording, setup(), settings);
    settings.process_noise_scale *= scale;
    settings.choose_process_noise_scale = false;
    S2kfConverter converter(setup(), settings);
    ConversionResult result = converter.Convert(recording, progress);
    result.noise_scale = scale;
    return result;
  }
  if (!settings_.smoothing) {
    return MotionConverter::Convert(recording, progress);
  }
  Checkpoints checkpoints;
  ConversionResult result = MotionConverter::Convert(recording, [&](int done) {
    if (checkpoints.first < 0) checkpoints.first = done - 1;
    KeepCheckpoint(done - 1, &checkpoints);
    return !progress || progress(done);
  });
  FindRetakes(recording, result, &checkpoints);
  if (!checkpoints.retakes.empty()) TrackFromRetakes(recording, &checkpoints);
  Smooth(recording, checkpoints, &result);
  Differentiate(&result.trajectory);
  return result;
}

void S2kfConverter::KeepCheckpoint(int k, Checkpoints* checkpoints) {
  const int since = k - checkpoints->first;
  if (since % settings_.smoothing_chunk != 0) return;
  const std::size_t i = since / settings_.smoothing_chunk;
  checkpoints->states.resize(std::max(checkpoints->states.size(), i + 1));
  track_.random = search_.random();
  track_.gate = gate_.state();
  checkpoints->states[i] = track_;
}

void S2kfConverter::FindRetakes(const MarkerSequence& recording, const ConversionResult& result,
                                Checkpoints* checkpoints) {
  const double dt = 1 / recording.rate();
  for (int k = recording.num_frames() - 1; k > checkpoints->first; --k) {
    if (!result.frames[k].reassembled) continue;
    filter_.StartAt(result.trajectory.postures[k], &track_.belief);
    Gather(recording.frame(k));
    z_ = measured_;
    filter_.Update(z_, &track_.belief);
    while (k > checkpoints->first) {
      if (Gather(recording.frame(k - 1)) == 0) break;
      z_ = measured_;
      // The motion model is the same backwards.
      filter_.Predict(dt, &track_.belief);
      filter_.Update(z_, &track_.belief);
      const double before = ClippedMean(result.residuals.col(k - 1));
      if (MeasuredDistance(track_.belief) > kNoFarther * before) break;
      --k;
      checkpoints->retakes[k] = posture_;
      checkpoints->retakes.erase(k + 1);
      if (IsSamePosture(posture_, result.trajectory.postures[k])) break;
    }
  }
}

void S2kfConverter::TrackFromRetakes(const MarkerSequence& recording, Checkpoints* checkpoints) {
  const int begin = checkpoints->retakes.begin()->first - checkpoints->first;
  const int chunk = begin / settings_.smoothing_chunk;
  Restore(*checkpoints, chunk);
  int k = checkpoints->first + chunk * settings_.smoothing_chunk;
  Retake(recording, k, *checkpoints);
  KeepCheckpoint(k, checkpoints);
  for (++k; k < recording.num_frames(); ++k) {
    TrackAgain(recording, k, *checkpoints);
    KeepCheckpoint(k, checkpoints);
  }
}

void S2kfConverter::Restore(const Checkpoints& checkpoints, int chunk) {
  track_ = checkpoints.states[chunk];
  search_.random() = track_.random;
  gate_.set_state(track_.gate);
}

void S2kfConverter::Retake(const MarkerSequence& recording, int k, const Checkpoints& checkpoints) {
  const auto found = checkpoints.retakes.find(k);
  if (found == checkpoints.retakes.end()) return;
  Gather(recording.frame(k));
  z_ = measured_;
  filter_.StartAt(found->second, &track_.belief);
  filter_.Update(z_, &track_.belief);
}

void S2kfConverter::TrackAgain(const MarkerSequence& recording, int k,
                               const Checkpoints& checkpoints) {
  Track(recording.frame(k), 1 / recording.rate());
  Retake(recording, k, checkpoints);
}

void S2kfConverter::Smooth(const MarkerSequence& recording, const Checkpoints& checkpoints,
                           ConversionResult* result) {
  TrajectorySmoother smoother(filter_.motion_model(), filter_.transform(), settings_.root,
                              kinematics_.num_dofs());
  const int chunk = settings_.smoothing_chunk;
  std::vector<Belief> filtered(std::min(chunk, recording.num_frames()));
  const int frames = recording.num_frames();
  for (int c = static_cast<int>(checkpoints.states.size()) - 1; c >= 0; --c) {
    const int begin = checkpoints.first + c * chunk;
    const int end = std::min(begin + chunk, frames);
    Restore(checkpoints, c);
    filtered[0] = track_.belief;
    for (int k = begin + 1; k < end; ++k) {
      const Clock::time_point start = Clock::now();
      TrackAgain(recording, k, checkpoints);
      filtered[k - begin] = track_.belief;
      result->frames[k].seconds += SecondsSince(start);
    }
    for (int k = end - 1; k >= begin; --k) {
      const Clock::time_point start = Clock::now();
      if (k == frames - 1) {
        smoother.Start(filtered[k - begin]);
      } else {
        smoother.StepBack(filtered[k - begin], 1 / recording.rate());
        Gather(recording.frame(k));
        if (!IsAsNear(smoother.belief(), filtered[k - begin])) smoother.Start(filtered[k - begin]);
      }
      WriteSmoothed(recording, k, smoother.belief(), result);
      result->frames[k].seconds += SecondsSince(start);
    }
  }
  for (int k = 0; k < checkpoints.first; ++k) {
    WriteSmoothed(recording, k, smoother.belief(), result);
  }
}

bool S2kfConverter::IsAsNear(const Belief& smoothed, const Belief& filtered) {
  const double limit = kMuchFarther * MeasuredDistance(filtered) + kMuchFartherDistance;
  const bool is_near = MeasuredDistance(smoothed) <= limit;
  return is_near && posture_.joint_angles.allFinite();
}

double S2kfConverter::MeasuredDistance(const Belief& belief) {
  Place(belief);
  return ClippedMean((measured_ - at_.p_WM).colwise().norm().transpose());
}

double S2kfConverter::ClippedMean(const VectorXd& distances) const {
  double sum = 0;
  int seen = 0;
  for (const double distance : distances) {
    if (!std::isfinite(distance)) continue;
    sum += std::min(distance, fit_options_.robust_distance);
    ++seen;
  }
  return sum / std::max(seen, 1);
}

void S2kfConverter::WriteSmoothed(const MarkerSequence& recording, int k, const Belief& belief,
                                  ConversionResult* result) {
  Gather(recording.frame(k));
  Place(belief);
  filter_.Deviations(belief, &deviations_);
  result->trajectory.postures[k] = posture_;
  result->trajectory.standard_deviations.col(k) = deviations_;
  result->residuals.col(k) = (measured_ - at_.p_WM).colwise().norm().transpose();
}

}  // namespace mmm_converter::s2kf
