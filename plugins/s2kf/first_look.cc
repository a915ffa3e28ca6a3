// SPDX-License-Identifier: MIT
#include "plugins/s2kf/first_look.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "common/math/statistics.h"
#include "common/model/posture.h"
#include "common/support/error.h"
#include "common/support/units.h"
#include "plugins/s2kf/marker_filter.h"
#include "plugins/s2kf/online_tracker.h"

namespace mmm_converter::s2kf {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

namespace {

// Of landmarks, all joints together are most likely with less noise than ankles need, which then
// lose a third of their range.
constexpr double kLeastScaleOfLandmarks = 0.25;

// Parts of the recording that are judged, each this long; the first frames of each, in which the
// start settles, do not count.
constexpr int kParts = 6;
constexpr int kPartFrames = 80;
constexpr int kSettling = 25;
constexpr std::size_t kRateFrames = 5;
constexpr int kFewestFrames = 10;
// From which places are learnt, about; they do not move.
constexpr int kMostResiduals = 1000;
// A marker's deviation about its place is that by which so many percent of its distances are that
// of a normal distribution (root of chi-square, 3 degrees of freedom): lengths that are not the
// person's move it far in some postures.
constexpr double kTail = 90;
constexpr double kDeviationsOfTail = 2.500;
// Of the scale, to the base 10.
constexpr double kLargestLog = 3;
constexpr double kStep = 0.5;

/// Frames of a recording that are judged together.
struct Part {
  int begin;
  int end;
  Posture start;
  Posture later;                  // kRateFrames after the start, or in the last frame
  std::vector<Matrix3Xd> frames;  // their markers, without those that are wrong
};

std::vector<Part> PartsOf(int frames) {
  const int parts = frames > kParts * kPartFrames ? kParts : 1;
  const int length = parts > 1 ? kPartFrames : frames;
  std::vector<Part> result;
  for (int p = 0; p < parts; ++p) {
    const int begin = parts > 1 ? static_cast<int>(1L * p * (frames - length) / (parts - 1)) : 0;
    result.push_back({begin, begin + length, {}, {}, {}});
  }
  return result;
}

/// Residuals of markers about the model's places, and their middle.
class Residuals {
 public:
  Residuals(const TrackedMarkers& markers, const S2kfSettings& settings)
      : markers_(markers),
        clip_(settings.robust_distance),
        samples_(markers.kinematics().num_markers()) {}

  void Add(const TrackedFrame& frame) {
    for (std::size_t m = 0; m < samples_.size(); ++m) {
      const auto i = static_cast<Eigen::Index>(m);
      const Vector3d r_W = frame.z.col(i) - frame.at.p_WM.col(i);
      if (!r_W.allFinite() || (clip_ > 0 && r_W.norm() > clip_)) continue;
      const int link = markers_.kinematics().link_of_marker(static_cast<int>(m));
      const Vector3d r = frame.at.R_WL[link].transpose() * r_W;
      for (int axis = 0; axis < 3; ++axis) samples_[m][axis].push_back(r[axis]);
    }
  }

  WornPlaces Places() const {
    const auto num_markers = static_cast<Eigen::Index>(samples_.size());
    WornPlaces places = {Matrix3Xd::Zero(3, num_markers),
                         Eigen::VectorXd::Constant(num_markers, kNaN)};
    for (Eigen::Index m = 0; m < num_markers; ++m) {
      const auto& samples = samples_[m];
      if (samples[0].size() < kFewestFrames || !std::isnan(markers_.place_deviation()[m])) continue;
      std::vector<double> apart(samples[0].size());
      for (int axis = 0; axis < 3; ++axis) {
        const double middle = Median(samples[axis]);
        places.offset(axis, m) = middle;
        for (std::size_t i = 0; i < apart.size(); ++i) {
          apart[i] = std::hypot(apart[i], samples[axis][i] - middle);
        }
      }
      places.deviation[m] = Percentile(apart, kTail) / kDeviationsOfTail;
    }
    return places;
  }

 private:
  const TrackedMarkers& markers_;
  double clip_;                                              // a farther marker is a wrong one [m]
  std::vector<std::array<std::vector<double>, 3>> samples_;  // by marker, in link axes [m]
};

/// Tracks the whole recording once. Takes the markers without those that are wrong, which are no
/// motion; by a random walk, as the noise of the velocities is not known yet.
void TrackOnce(const MarkerSequence& recording, const TrackedMarkers& markers,
               S2kfSettings settings, const std::function<bool(int)>& progress,
               std::vector<Part>* parts, Residuals* residuals) {
  settings.filter = FilterType::kEkf;
  settings.motion_model = MotionModelType::kRandomWalk;
  settings.process_noise_scale = 1;
  OnlineTracker tracker(markers, settings);
  TrackState state;
  TrackedFrame frame(markers.kinematics());
  const double dt = 1 / recording.rate();
  const int stride = 1 + recording.num_frames() / kMostResiduals;
  bool is_started = false;
  for (int k = 0; k < recording.num_frames(); ++k) {
    if (progress && !progress(0)) throw Error("cancelled before the first frame");
    if (is_started) {
      tracker.Track(recording.frame(k), dt, &state, &frame);
    } else if (markers.Gather(recording.frame(k), &frame.measured) >= kFewestMarkers) {
      tracker.Start(recording.frame(k), &state, &frame);
      is_started = true;
    } else {
      continue;
    }
    if (k % stride == 0) residuals->Add(frame);
    for (Part& part : *parts) {
      if (k < part.begin || k >= part.end) continue;
      if (part.frames.empty()) part.start = frame.posture;
      part.frames.push_back(frame.z);
      if (part.frames.size() <= kRateFrames + 1) part.later = frame.posture;
    }
  }
}

/// The likelihood of a recording, part by part.
class Likelihood {
 public:
  /// All must outlive the object.
  Likelihood(const std::vector<Part>& parts, double dt, const TrackedMarkers& markers,
             const S2kfSettings& settings)
      : parts_(parts), dt_(dt), markers_(markers), settings_(settings) {
    settings_.filter = FilterType::kEkf;
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
      if (!part.frames.empty()) Start(part, &filter, &belief);
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
  /// With the rates of the first frames: a filter that starts at rest loses quick limbs.
  void Start(const Part& part, MarkerFilter* filter, Belief* belief) {
    filter->StartAt(part.start, belief);
    const std::size_t frames = std::min(kRateFrames, part.frames.size() - 1);
    if (belief->rate.size() == 0 || frames == 0) return;
    filter->StartAt(part.later, &later_);
    Difference(*belief, later_, settings_.root, &step_);
    belief->rate = step_.head(belief->rate.size()) / (static_cast<double>(frames) * dt_);
  }

  const std::vector<Part>& parts_;
  double dt_;
  const TrackedMarkers& markers_;
  S2kfSettings settings_;
  std::map<double, double> values_;
  Belief later_;
  Eigen::VectorXd step_;
};

/// Where the parabola through `best` and its neighbours is highest, in steps from it.
double TopOfParabola(Likelihood& likelihood, double best) {
  const double middle = likelihood.At(best);
  const double below = middle - likelihood.At(best - kStep);
  const double above = middle - likelihood.At(best + kStep);
  if (!(below + above > 0)) return 0;
  return std::clamp(0.5 * (below - above) / (below + above), -0.5, 0.5);
}

double ChooseScale(Likelihood likelihood) {
  if (likelihood.num_frames() < kFewestFrames) return 1;
  // Uphill from the calmest motion to the first top: under much noise joints also take up that
  // markers sit elsewhere than the model has them, which has a top of its own.
  double best = -kLargestLog;
  while (best < kLargestLog && likelihood.At(best + kStep) > likelihood.At(best)) best += kStep;
  const double top = best + kStep * TopOfParabola(likelihood, best);
  return std::pow(10.0, std::clamp(top, -kLargestLog, kLargestLog));
}

}  // namespace

FirstLook LookOver(const MarkerSequence& recording, const TrackedMarkers& markers,
                   const S2kfSettings& settings, const std::function<bool(int)>& progress) {
  std::vector<Part> parts = PartsOf(recording.num_frames());
  Residuals residuals(markers, settings);
  TrackOnce(recording, markers, settings, progress, &parts, &residuals);
  FirstLook look;
  if (settings.learn_places) look.places = residuals.Places();
  if (settings.choose_process_noise_scale) {
    const TrackedMarkers worn = look.places ? markers.Worn(*look.places) : markers;
    look.process_noise_scale = ChooseScale(Likelihood(parts, 1 / recording.rate(), worn, settings));
    if (markers.MeanTrust() > 1) {
      look.process_noise_scale = std::max(*look.process_noise_scale, kLeastScaleOfLandmarks);
    }
  }
  return look;
}

}  // namespace mmm_converter::s2kf
