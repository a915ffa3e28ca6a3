// SPDX-License-Identifier: MIT
#include "plugins/s2kf/posture_recovery.h"

#include <algorithm>
#include <utility>

namespace mmm_converter::s2kf {

namespace {

// Of one fit in a doubtful frame, which has to be ready before the next; the next one goes on.
constexpr int kFitIterations = 12;
// Of one that is done once in a gap.
constexpr int kSearchIterations = 30;

}  // namespace

PostureFitOptions FitOptions(const S2kfSettings& settings) {
  PostureFitOptions options;
  if (settings.robust_distance > 0) options.robust_distance = settings.robust_distance;
  return options;
}

PostureRecovery::PostureRecovery(const TrackedMarkers& markers, const S2kfSettings& settings)
    : options_(FitOptions(settings)),
      start_attempts_(settings.start_attempts),
      scale_(markers.noise_scale() * std::max(1.0, markers.MeanTrust())),
      search_(markers.kinematics()) {
  fresh_.joint_angles.setZero(markers.kinematics().num_joints());
  options_.max_iterations = kFitIterations;
  options_.pulls = markers.pulls();
  search_options_ = options_;
  search_options_.max_iterations = kSearchIterations;
}

void PostureRecovery::Assemble(const TrackedFrame& frame, std::mt19937* random, Posture* posture) {
  search_.Assemble(frame.measured, scale_, options_, start_attempts_, posture);
  *random = search_.random();
}

bool PostureRecovery::FindBetter(const TrackedFrame& frame, const TrackWatch& watch,
                                 std::mt19937* random, Posture* posture) {
  PostureFit& fit = search_.fit();
  const Eigen::VectorXd& scale = scale_;
  *posture = frame.posture;
  const PostureFit::Result before = fit.Evaluate(frame.z, scale, options_, frame.posture);
  fit.Solve(frame.z, scale, options_, posture);
  std::swap(search_.random(), *random);
  search_.Improve(frame.z, scale, options_, posture);
  std::swap(search_.random(), *random);
  const PostureFit::Result after = fit.Evaluate(frame.z, scale, options_, *posture);
  return watch.IsClearlyBetter(before, after, CountSeen(frame.z), static_cast<int>(frame.z.cols()));
}

void PostureRecovery::FindAgain(const TrackedFrame& frame, const Posture& held,
                                const TrackWatch& watch, std::mt19937* random, Posture* posture) {
  PostureFit& fit = search_.fit();
  *posture = held;
  fit.Solve(frame.z, scale_, search_options_, posture);
  search_.ImproveFrom(held.joint_angles, frame.z, scale_, search_options_, posture);
  fresh_ = held;
  fresh_.joint_angles = fit.natural_angles();
  search_.ImproveFrom(fit.natural_angles(), frame.z, scale_, search_options_, &fresh_);
  std::swap(search_.random(), *random);
  for (int i = 0; i < start_attempts_; ++i) {
    search_.Improve(frame.z, scale_, options_, &fresh_);
  }
  std::swap(search_.random(), *random);
  const PostureFit::Result before = fit.Evaluate(frame.z, scale_, options_, *posture);
  const PostureFit::Result after = fit.Evaluate(frame.z, scale_, options_, fresh_);
  const int seen = CountSeen(frame.z), all = static_cast<int>(frame.z.cols());
  if (watch.IsClearlyBetter(before, after, seen, all)) *posture = fresh_;
}

bool PostureRecovery::FindForAll(const TrackedFrame& frame, int left_out, const TrackWatch& watch,
                                 Posture* posture) {
  if (!watch.MayBeRight(left_out)) return false;
  PostureFit& fit = search_.fit();
  const Eigen::VectorXd& scale = scale_;
  *posture = frame.posture;
  fit.Solve(frame.relabelled, scale, options_, posture);
  const double all = fit.Evaluate(frame.relabelled, scale, options_, *posture).cost;
  const double used = fit.Evaluate(frame.z, scale, options_, *posture).cost;
  return watch.ExplainsLeftOut(used, CountSeen(frame.z), all - used, left_out);
}

}  // namespace mmm_converter::s2kf
