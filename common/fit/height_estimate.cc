// SPDX-License-Identifier: MIT
#include "common/fit/height_estimate.h"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <utility>

#include "common/fit/posture_search.h"
#include "common/model/model_scaling.h"
#include "common/support/error.h"

namespace mmm_converter {

namespace {

constexpr int kHeightFrames = 12;
constexpr int kLeastMarkers = 10;
constexpr int kHeightAttempts = 4;
constexpr double kShortest = 1.0;
constexpr double kTallest = 2.2;
constexpr double kTypical = 1.7;
// Winter's scaling wants a mass; markers do not depend on it.
constexpr double kAnyMass = 70;

struct FittedFrame {
  Eigen::Matrix3Xd z;
  Posture posture;
};

/// One frame out of each of kHeightFrames equal parts of the recording.
std::vector<FittedFrame> ChooseFrames(const std::vector<LabelIx>& labels,
                                      const MarkerSequence& recording,
                                      const std::vector<Posture>* track) {
  std::vector<FittedFrame> frames;
  for (int part = 0; part < kHeightFrames; ++part) {
    const long n = recording.num_frames();
    const int begin = static_cast<int>(n * part / kHeightFrames);
    const int end = static_cast<int>(n * (part + 1) / kHeightFrames);
    int best = -1;
    int most = kLeastMarkers - 1;
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

}  // namespace

HeightEstimate EstimateHeight(const KinematicModel& reference, const std::vector<int>& joints,
                              const std::vector<MarkerIx>& markers,
                              const std::vector<LabelIx>& labels, const MarkerSequence& recording,
                              const std::vector<Posture>* track) {
  std::vector<FittedFrame> frames = ChooseFrames(labels, recording, track);
  if (frames.empty()) {
    throw Error("the body height can't be estimated: no frame shows at least " +
                    std::to_string(kLeastMarkers) + " mapped markers; give it",
                Remedy::kHeight);
  }
  const Eigen::VectorXd scale = Eigen::VectorXd::Ones(static_cast<int>(markers.size()));
  PostureFitOptions options;
  options.robust_distance = 0.1;
  HeightEstimate result;
  result.frames = static_cast<int>(frames.size());
  const auto cost_at = [&](double height) {
    const KinematicModel model = ScaleWinter(reference, {height, kAnyMass, {}});
    const MarkerKinematics kinematics(model, joints, markers);
    PostureSearch search(kinematics);
    double cost = 0;
    result.mean_distance = 0;
    for (FittedFrame& frame : frames) {
      PostureFit::Result fit;
      if (frame.posture.joint_angles.size() == 0) {
        fit = search.Assemble(frame.z, scale, options, kHeightAttempts, &frame.posture);
      } else {
        fit = search.fit().Solve(frame.z, scale, options, &frame.posture);
      }
      cost += fit.cost;
      result.mean_distance += fit.mean_distance / result.frames;
    }
    return cost;
  };
  cost_at(kTypical);
  // Heights to 1 mm: 10 bits of the interval.
  constexpr int kBits = 10;
  result.height = boost::math::tools::brent_find_minima(cost_at, kShortest, kTallest, kBits).first;
  cost_at(result.height);
  return result;
}

}  // namespace mmm_converter
