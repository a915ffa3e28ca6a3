// SPDX-License-Identifier: MIT
#include "common/fit/height_estimate.h"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <functional>
#include <utility>

#include "common/fit/posture_search.h"
#include "common/model/model_scaling.h"
#include "common/support/error.h"

namespace mmm_converter {

namespace {

constexpr int kHeightFrames = 12;
constexpr int kEnoughMarkers = 10;
constexpr int kHeightAttempts = 4;
constexpr double kShortest = 1.0;
constexpr double kTallest = 2.2;
constexpr double kTypical = 1.7;
// Winter's scaling wants a mass; markers do not depend on it.
constexpr double kAnyMass = 70;
// Of markers from the places that the model has for them, on each axis [m].
constexpr double kMarkerDeviation = 0.028;

struct FittedFrame {
  Eigen::Matrix3Xd z;
  Posture posture;
};

/// One frame out of each of kHeightFrames equal parts of the recording, where it shows enough.
std::vector<FittedFrame> ChooseFrames(const std::vector<LabelIx>& labels,
                                      const MarkerSequence& recording,
                                      const std::vector<Posture>* track, int least) {
  std::vector<FittedFrame> frames;
  for (int part = 0; part < kHeightFrames; ++part) {
    const long n = recording.num_frames();
    const int begin = static_cast<int>(n * part / kHeightFrames);
    const int end = static_cast<int>(n * (part + 1) / kHeightFrames);
    int best = -1;
    int most = least - 1;
    for (int k = begin; k < end; ++k) {
      const auto seen = std::count_if(labels.begin(), labels.end(), [&](int label) {
        return IsSeen(recording.frame(k).col(label));
      });
      if (seen > most) {
        most = static_cast<int>(seen);
        best = k;
      }
    }
    if (best < 0) continue;
    const Posture start = track == nullptr ? Posture() : (*track)[static_cast<std::size_t>(best)];
    frames.push_back({recording.frame(best)(Eigen::all, labels), start});
  }
  return frames;
}

/// What a height costs: the markers' distances, and how unusual it is.
class HeightCost {
 public:
  HeightCost(const KinematicModel& reference, const std::vector<int>& joints,
             const std::vector<MarkerIx>& markers, const HeightOptions& options,
             std::vector<FittedFrame> frames)
      : reference_(reference),
        joints_(joints),
        markers_(markers),
        scale_(options.noise_scale),
        frames_(std::move(frames)) {
    if (scale_.size() == 0) scale_.setOnes(static_cast<int>(markers.size()));
    options_.robust_distance = 0.1;
  }

  void set_with_ordinary_height() { with_ordinary_height_ = true; }
  double mean_distance() const { return mean_distance_; }

  /// [m^2], of all frames; the next height starts from the postures of this one.
  double operator()(double height) {
    const KinematicModel model = ScaleWinter(reference_, {height, kAnyMass, {}});
    const MarkerKinematics kinematics(model, joints_, markers_);
    PostureSearch search(kinematics);
    const auto count = static_cast<double>(frames_.size());
    double cost = 0;
    mean_distance_ = 0;
    for (FittedFrame& frame : frames_) {
      PostureFit::Result fit;
      if (frame.posture.joint_angles.size() == 0) {
        fit = search.Assemble(frame.z, scale_, options_, kHeightAttempts, &frame.posture);
      } else {
        fit = search.fit().Solve(frame.z, scale_, options_, &frame.posture);
      }
      cost += fit.cost;
      mean_distance_ += fit.mean_distance / count;
    }
    if (!with_ordinary_height_) return cost;
    // Places that are off are off in all frames: these are not evidence that adds up.
    const double unusual = (height - kOrdinaryHeight) / kHeightDeviation;
    return cost + count * kMarkerDeviation * kMarkerDeviation * unusual * unusual;
  }

  /// By the curvature of the cost about its minimum [m].
  double DeviationAt(double height) {
    constexpr double kStep = 0.04;  // [m]
    const double middle = (*this)(height);
    const double curvature =
        ((*this)(height + kStep) - 2 * middle + (*this)(height - kStep)) / (kStep * kStep);
    const double unit =
        2 * static_cast<double>(frames_.size()) * kMarkerDeviation * kMarkerDeviation;
    return curvature > 0 ? std::min(std::sqrt(unit / curvature), kHeightDeviation)
                         : kHeightDeviation;
  }

 private:
  const KinematicModel& reference_;
  const std::vector<int>& joints_;
  const std::vector<MarkerIx>& markers_;
  Eigen::VectorXd scale_;
  std::vector<FittedFrame> frames_;
  PostureFitOptions options_;
  bool with_ordinary_height_ = false;
  double mean_distance_ = 0;
};

}  // namespace

HeightEstimate EstimateHeight(const KinematicModel& reference, const std::vector<int>& joints,
                              const std::vector<MarkerIx>& markers,
                              const std::vector<LabelIx>& labels, const MarkerSequence& recording,
                              const HeightOptions& options) {
  bool with_ordinary_height = options.with_ordinary_height;
  std::vector<FittedFrame> frames = ChooseFrames(labels, recording, options.track, kEnoughMarkers);
  if (frames.empty()) {
    with_ordinary_height = true;
    frames = ChooseFrames(labels, recording, options.track, kFewestMarkers);
  }
  if (frames.empty()) {
    throw Error("the body height can't be estimated: no frame shows three mapped markers; give it",
                Remedy::kHeight);
  }
  HeightEstimate result;
  result.frames = static_cast<int>(frames.size());
  HeightCost cost(reference, joints, markers, options, std::move(frames));
  if (with_ordinary_height) cost.set_with_ordinary_height();
  cost(kTypical);
  // Heights to 1 mm: 10 bits of the interval.
  constexpr int kBits = 10;
  result.height =
      boost::math::tools::brent_find_minima(std::ref(cost), kShortest, kTallest, kBits).first;
  if (with_ordinary_height) result.deviation = cost.DeviationAt(result.height);
  cost(result.height);
  result.mean_distance = cost.mean_distance();
  return result;
}

}  // namespace mmm_converter
