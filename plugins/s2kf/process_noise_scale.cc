// SPDX-License-Identifier: MIT
#include "plugins/s2kf/process_noise_scale.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "common/fit/posture_search.h"
#include "plugins/s2kf/marker_filter.h"
#include "plugins/s2kf/posture_recovery.h"

namespace mmm_converter::s2kf {

using Eigen::Matrix3Xd;

namespace {

// Parts of the recording that are judged, each this long; the first frames of each, in which the
// start settles, do not count.
constexpr int kParts = 4;
constexpr int kPartFrames = 250;
constexpr int kSettling = 25;
constexpr int kFewestFrames = 10;
constexpr int kFewestMarkers = 3;
constexpr double kLargestLog = 3;  // of the scale, to the base 10

/// The likelihood of a recording, part by part.
class Likelihood {
 public:
  Likelihood(const MarkerSequence& recording, const TrackedMarkers& markers,
             const S2kfSettings& settings)
      : markers_(markers), settings_(settings), dt_(1 / recording.rate()) {
    settings_.filter = FilterType::kEkf;
    const int frames = recording.num_frames();
    const int parts = frames > kParts * kPartFrames ? kParts : 1;
    const int length = parts > 1 ? kPartFrames : frames;
    for (int p = 0; p < parts; ++p) {
      const int begin = parts > 1 ? static_cast<int>(1L * p * (frames - length) / (parts - 1)) : 0;
      AddPart(recording, begin, begin + length);
    }
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
    MarkerFilter filter(markers_.kinematics(), settings, markers_.noise_scale());
    UpdateOutcome outcome = filter.MakeOutcome();
    double sum = 0;
    for (const Part& part : parts_) {
      Belief belief;
      filter.StartAt(part.start, &belief);
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
    Posture start;
    std::vector<Matrix3Xd> frames;
  };

  void AddPart(const MarkerSequence& recording, int begin, int end) {
    Part part;
    Matrix3Xd z(3, markers_.kinematics().num_markers());
    for (int k = begin; k < end; ++k) {
      const int seen = markers_.Gather(recording.frame(k), &z);
      if (part.frames.empty() && seen < kFewestMarkers) continue;
      part.frames.push_back(z);
    }
    if (part.frames.empty()) return;
    PostureSearch search(markers_.kinematics());
    search.Assemble(part.frames.front(), markers_.noise_scale(), FitOptions(settings_),
                    settings_.start_attempts, &part.start);
    parts_.push_back(std::move(part));
  }

  const TrackedMarkers& markers_;
  S2kfSettings settings_;
  double dt_;
  std::vector<Part> parts_;
  std::map<double, double> values_;
};

}  // namespace

double ChooseProcessNoiseScale(const MarkerSequence& recording, const TrackedMarkers& markers,
                               const S2kfSettings& settings) {
  Likelihood likelihood(recording, markers, settings);
  if (likelihood.num_frames() < kFewestFrames) return 1;
  // Uphill from the calmest motion to the first top: under much noise joints also take up that
  // markers sit elsewhere than the model has them, which has a top of its own.
  constexpr double kStep = 0.5;
  double best = -kLargestLog;
  while (best < kLargestLog && likelihood.At(best + kStep) > likelihood.At(best)) best += kStep;
  for (const double step : {kStep / 2, kStep / 4}) {
    const double next = likelihood.At(best + step) > likelihood.At(best - step) ? step : -step;
    if (likelihood.At(best + next) > likelihood.At(best)) best += next;
  }
  return std::pow(10.0, best);
}

}  // namespace mmm_converter::s2kf
