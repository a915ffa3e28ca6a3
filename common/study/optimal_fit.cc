// SPDX-License-Identifier: MIT
#include "common/study/optimal_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/fit/posture_fit.h"
#include "common/fit/posture_search.h"
#include "common/model/marker_kinematics.h"
#include "common/model/posture.h"
#include "common/motion/marker_synthesis.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr int kFitAttempts = 20;

// Fits frames of a recording, each starting from the one before.
class OptimumFit {
 public:
  OptimumFit(const KinematicModel& model, const std::vector<int>& joints,
             const std::vector<MarkerIx>& markers, const std::vector<LabelIx>& labels,
             const MarkerSequence& recording)
      : labels_(labels),
        recording_(recording),
        kinematics_(model, joints, markers),
        search_(kinematics_),
        scale_(Eigen::VectorXd::Ones(kinematics_.num_markers())),
        optima_(static_cast<std::size_t>(recording.num_frames())) {
    options_.tolerance = 1e-6;
    options_.max_iterations = 50;
  }

  // More postures that the fit of a frame may start from.
  using Starts = std::function<void(int frame, const std::function<void(const Posture&)>& offer)>;

  void Fit(int k, const Starts& starts) {
    const Eigen::Matrix3Xd z = recording_.frame(k)(Eigen::all, labels_);
    if (z.array().isFinite().colwise().all().count() < kFewestMarkers) return;
    PostureFit::Result result;
    if (is_assembled_) {
      if (starts) StartFromNearest(k, z, starts);
      result = search_.fit().Solve(z, scale_, options_, &posture_);
    } else {
      result = search_.Assemble(z, scale_, options_, kFitAttempts, &posture_);
      is_assembled_ = true;
    }
    Optimum& optimum = optima_[static_cast<std::size_t>(k)];
    if (result.cost < optimum.cost) optimum = {posture_, result.cost, result.mean_distance};
    posture_ = optimum.posture;
  }

  // As if that frame had just been fitted.
  void ContinueFrom(int k) {
    const Optimum& optimum = optima_[static_cast<std::size_t>(k)];
    if (std::isfinite(optimum.cost)) posture_ = optimum.posture;
  }

  // NaN: was not fitted, or can't be.
  double Distance(int k) const { return optima_[static_cast<std::size_t>(k)].distance; }

 private:
  struct Optimum {
    Posture posture;
    double cost = std::numeric_limits<double>::infinity();
    double distance = kNaN;
  };

  void StartFromNearest(int k, const Eigen::Matrix3Xd& z, const Starts& starts) {
    double cost = search_.fit().Evaluate(z, scale_, options_, posture_).cost;
    starts(k, [&](const Posture& offered) {
      const double other = search_.fit().Evaluate(z, scale_, options_, offered).cost;
      if (other >= cost) return;
      cost = other;
      posture_ = offered;
    });
  }

  const std::vector<LabelIx>& labels_;
  const MarkerSequence& recording_;
  MarkerKinematics kinematics_;
  PostureSearch search_;
  Eigen::VectorXd scale_;
  PostureFitOptions options_;
  std::vector<Optimum> optima_;
  Posture posture_;
  bool is_assembled_ = false;
};

// Least and most that the optimum between two fitted frames is taken to be.
std::pair<double, double> RangeBetween(double before, double behind) {
  constexpr double kMargin = 0.1;
  const double change = std::abs(behind - before);
  const auto [least, most] = std::minmax(before, behind);
  return {(1 - kMargin) * least - change, (1 + kMargin) * most + change};
}

}  // namespace

Eigen::VectorXd OptimalDistances(const KinematicModel& model, const std::vector<int>& joints,
                                 const std::vector<MarkerIx>& markers,
                                 const std::vector<LabelIx>& labels,
                                 const MarkerSequence& recording) {
  OptimumFit fit(model, joints, markers, labels, recording);
  const int frames = recording.num_frames();
  for (int k = 0; k < frames; ++k) fit.Fit(k, nullptr);
  for (int k = frames - 1; k >= 0; --k) fit.Fit(k, nullptr);
  Eigen::VectorXd distances(frames);
  for (int k = 0; k < frames; ++k) distances[k] = fit.Distance(k);
  return distances;
}

Eigen::VectorXd SampledOptimalDistances(const KinematicModel& model, const std::vector<int>& joints,
                                        const std::vector<MarkerIx>& markers,
                                        const std::vector<LabelIx>& labels,
                                        const MarkerSequence& recording,
                                        const OptimumSampling& sampling) {
  const auto starts = [&](int k, const std::function<void(const Posture&)>& offer) {
    for (const PoseTrajectory* tracked : sampling.tracked) {
      Posture posture = ModelPosture(model, *tracked, k);
      posture.joint_angles = Eigen::VectorXd(posture.joint_angles(joints));
      offer(posture);
    }
  };
  OptimumFit fit(model, joints, markers, labels, recording);
  const int last = recording.num_frames() - 1;
  std::vector<int> fitted;
  for (int k = 0; k < last; k += sampling.every) fitted.push_back(k);
  if (last >= 0) fitted.push_back(last);
  for (const int k : fitted) fit.Fit(k, starts);
  std::for_each(fitted.rbegin(), fitted.rend(), [&](int k) { fit.Fit(k, starts); });

  Eigen::VectorXd distances(recording.num_frames());
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    const int begin = fitted[i];
    distances[begin] = fit.Distance(begin);
    sampling.is_doubtful(begin, distances[begin], distances[begin]);
    if (begin == last) break;
    const int end = fitted[i + 1];
    fit.ContinueFrom(begin);
    const bool is_known = std::isfinite(distances[begin]) && std::isfinite(fit.Distance(end));
    const auto [least, most] = RangeBetween(distances[begin], fit.Distance(end));
    for (int k = begin + 1; k < end; ++k) {
      const Eigen::Matrix3Xd z = recording.frame(k)(Eigen::all, labels);
      const bool is_seen = z.array().isFinite().colwise().all().count() >= kFewestMarkers;
      if (is_known && is_seen && !sampling.is_doubtful(k, least, most)) {
        const double share = static_cast<double>(k - begin) / (end - begin);
        distances[k] = (1 - share) * distances[begin] + share * fit.Distance(end);
        continue;
      }
      fit.Fit(k, starts);
      distances[k] = fit.Distance(k);
      sampling.is_doubtful(k, distances[k], distances[k]);
    }
  }
  return distances;
}

}  // namespace mmm_converter
