// SPDX-License-Identifier: MIT
#include "plugins/s2kf/process_noise_scale.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "common/model/posture.h"
#include "common/support/error.h"
#include "plugins/s2kf/marker_filter.h"
#include "plugins/s2kf/online_tracker.h"

namespace mmm_converter::s2kf {

using Eigen::Matrix3Xd;

namespace {

// Parts of the recording that are judged, each this long; the first frames of each, in which the
// start settles, do not count.
constexpr int kParts = 6;
constexpr int kPartFrames = 80;
constexpr int kSettling = 25;
constexpr int kFewestFrames = 10;
// Of the scale, to the base 10.
constexpr double kLargestLog = 3;
constexpr double kStep = 0.5;

/// The likelihood of a recording, part by part.
class Likelihood {
 public:
  Likelihood(const MarkerSequence& recording, const TrackedMarkers& markers,
             const S2kfSettings& settings, const std::function<bool(int)>& progress)
      : markers_(markers), settings_(settings), dt_(1 / recording.rate()) {
    settings_.filter = FilterType::kEkf;
    const int frames = recording.num_frames();
    const int parts = frames > kParts * kPartFrames ? kParts : 1;
    const int length = parts > 1 ? kPartFrames : frames;
    for (int p = 0; p < parts; ++p) {
      const int begin = parts > 1 ? static_cast<int>(1L * p * (frames - length) / (parts - 1)) : 0;
      parts_.push_back({begin, begin + length, {}, {}});
    }
    TrackOnce(recording, progress);
  }

  int num_frames() const {
    int frames = 0;
    for (const Part& part : parts_) {
      frames += std::max(0, static_cast<int>(part.frames.size()) - kSettling);
    }
    return frames;
  }

  /// Of the process noise times 10^log_scale.
  double At(double log_scale) {
    const auto known = values_.find(log_scale);
    if (known != values_.end()) return known->second;
    S2kfSettings settings = settings_;
    settings.process_noise_scale *= std::pow(10.0, log_scale);
    MarkerFilter filter(markers_.kinematics(), settings,
                        markers_.FilterScale(settings.marker_deviation));
    UpdateOutcome outcome = filter.MakeOutcome();
    double sum = 0;
    for (const Part& part : parts_) {
      Belief belief;
      if (!part.frames.empty()) filter.StartAt(part.start, &belief);
      for (std::size_t k = 0; k < part.frames.size(); ++k) {
        if (k > 0) filter.Predict(dt_, &belief);
        filter.Update(part.frames[k], &belief, &outcome);
        if (k >= kSettling) sum += outcome.log_likelihood;
      }
    }
    values_[log_scale] = sum;
    return sum;
  }

 private:
  struct Part {
    int begin;
    int end;
    Posture start;
    std::vector<Matrix3Xd> frames;
  };

  /// Takes the markers of all parts without those that are wrong, which are no motion. Tracks by a
  /// random walk, as the noise of the velocities is not known yet.
  void TrackOnce(const MarkerSequence& recording, const std::function<bool(int)>& progress) {
    S2kfSettings settings = settings_;
    settings.motion_model = MotionModelType::kRandomWalk;
    settings.process_noise_scale = 1;
    OnlineTracker tracker(markers_, settings);
    TrackState state;
    TrackedFrame frame(markers_.kinematics());
    bool is_started = false;
    for (int k = 0; k < recording.num_frames(); ++k) {
      if (progress && !progress(0)) throw Error("cancelled before the first frame");
      if (is_started) {
        tracker.Track(recording.frame(k), dt_, &state, &frame);
      } else if (markers_.Gather(recording.frame(k), &frame.measured) >= kFewestMarkers) {
        tracker.Start(recording.frame(k), &state, &frame);
        is_started = true;
      } else {
        continue;
      }
      for (Part& part : parts_) {
        if (k < part.begin || k >= part.end) continue;
        if (part.frames.empty()) part.start = frame.posture;
        part.frames.push_back(frame.z);
      }
    }
  }

  const TrackedMarkers& markers_;
  S2kfSettings settings_;
  double dt_;
  std::vector<Part> parts_;
  std::map<double, double> values_;
};

/// Where the parabola through `best` and its neighbours is highest, in steps from it.
double TopOfParabola(Likelihood& likelihood, double best) {
  const double middle = likelihood.At(best);
  const double below = middle - likelihood.At(best - kStep);
  const double above = middle - likelihood.At(best + kStep);
  if (!(below + above > 0)) return 0;
  return std::clamp(0.5 * (below - above) / (below + above), -0.5, 0.5);
}

}  // namespace

double ChooseProcessNoiseScale(const MarkerSequence& recording, const TrackedMarkers& markers,
                               const S2kfSettings& settings,
                               const std::function<bool(int)>& progress) {
  Likelihood likelihood(recording, markers, settings, progress);
  if (likelihood.num_frames() < kFewestFrames) return 1;
  // Uphill from the calmest motion to the first top: under much noise joints also take up that
  // markers sit elsewhere than the model has them, which has a top of its own.
  double best = -kLargestLog;
  while (best < kLargestLog && likelihood.At(best + kStep) > likelihood.At(best)) best += kStep;
  const double top = best + kStep * TopOfParabola(likelihood, best);
  return std::pow(10.0, std::clamp(top, -kLargestLog, kLargestLog));
}

}  // namespace mmm_converter::s2kf
