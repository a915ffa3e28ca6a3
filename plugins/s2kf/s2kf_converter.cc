// SPDX-License-Identifier: MIT
#include "plugins/s2kf/s2kf_converter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "common/support/error.h"

namespace mmm_converter::s2kf {

using Eigen::Matrix3Xd;
using Eigen::Ref;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// A track is in doubt for this many frames after its start or after a cause of doubt.
constexpr int kDoubtFrames = 20;
// So many markers that come back together after having been hidden for longer than this [s] may
// stand where the filter does not expect them.
constexpr int kManyReturned = 3;
constexpr double kLongGap = 0.1;
// Distances this much above their usual level are a cause of doubt.
constexpr double kDoubtFactor = 1.15;
constexpr double kDoubtDistance = 0.001;
// The usual level follows with this time constant [s].
constexpr double kLevelTime = 1.0;
// A found posture must lower the cost by this share to replace the filter's: the filter smooths, so
// its posture never has the least cost. Markers that are not seen leave a fit free, and a track
// that is smoothed is cut where it is taken up anew: there the mean distance must fall, too, by up
// to the noise of a marker.
constexpr double kClearlyBetter = 0.1;

// Of one fit in a doubtful frame, which has to be ready before the next; the next one goes on.
constexpr int kFitIterations = 12;

// So many markers left out may be right together, and do so where a posture exists at which their
// mean squared distance is no more than this many times the others'.
constexpr int kManyLeftOut = 2;
constexpr double kAsWell = 4;

// Of a frame, until no more markers are left out.
constexpr int kGatePasses = 4;

int CountSeen(const Matrix3Xd& z) {
  int seen = 0;
  for (Eigen::Index m = 0; m < z.cols(); ++m) seen += z.col(m).allFinite();
  return seen;
}

}  // namespace

S2kfConverter::S2kfConverter(const TrackingSetup& setup, const S2kfSettings& settings)
    : MotionConverter(setup),
      settings_(settings),
      kinematics_(*setup.model, setup.joints, MarkerIndices(setup.assignments())),
      labels_(LabelIndices(setup.assignments())),
      noise_scale_(NoiseScales(setup.assignments())),
      filter_(kinematics_, settings, noise_scale_),
      gate_(kinematics_, settings.gate_probability),
      search_(kinematics_),
      at_(kinematics_.MakeJacobian()),
      measured_(3, kinematics_.num_markers()),
      z_(3, kinematics_.num_markers()) {
  track_.hidden_for.assign(labels_.size(), 0.0);
  fit_options_.max_iterations = kFitIterations;
  if (settings.robust_distance > 0) fit_options_.robust_distance = settings.robust_distance;
  posture_.joint_angles.setZero(kinematics_.num_joints());
  candidate_ = posture_;
  deviations_.setZero(kinematics_.num_dofs());
  estimate_.posture.joint_angles.setZero(setup.model->num_joints());
  estimate_.standard_deviations.setConstant(6 + setup.model->num_joints(), kNaN);
  estimate_.residuals.setConstant(kinematics_.num_markers(), kNaN);
  estimate_.verdicts.setConstant(kinematics_.num_markers(), kAsLabelled);
}

int S2kfConverter::Gather(const Ref<const Matrix3Xd>& frame) {
  int seen = 0;
  for (std::size_t i = 0; i < labels_.size(); ++i) {
    measured_.col(i) = frame.col(labels_[i]);
    if (measured_.col(i).allFinite()) {
      ++seen;
    } else {
      measured_.col(i).setConstant(kNaN);
    }
  }
  return seen;
}

void S2kfConverter::Place(const Belief& belief) {
  filter_.ToPosture(belief, &posture_);
  kinematics_.ComputeMarkers(posture_.position, posture_.orientation.toRotationMatrix(),
                             posture_.joint_angles, &at_);
}

MarkerFilter::Outcome S2kfConverter::UpdateBySelected() {
  gate_.Select(measured_, &z_);
  track_.belief = prior_;
  const MarkerFilter::Outcome outcome = filter_.Update(z_, &track_.belief);
  Place(track_.belief);
  return outcome;
}

MarkerFilter::Outcome S2kfConverter::Update() {
  prior_ = track_.belief;
  MarkerFilter::Outcome outcome = UpdateBySelected();
  if (settings_.gate_probability <= 0 || outcome.seen == 0) return outcome;
  if (gate_.is_any_wrong() || gate_.IsSuspicious(z_, at_)) Judge(&outcome);
  gate_.Learn(z_, at_);
  return outcome;
}

void S2kfConverter::Judge(MarkerFilter::Outcome* outcome) {
  Place(prior_);
  if (gate_.ExchangeByPrior(measured_, at_)) {
    *outcome = UpdateBySelected();
  } else {
    Place(track_.belief);
  }
  gate_.Expect(z_, at_, &filter_);
  for (int i = 0; i < kGatePasses && gate_.LeaveOutWorst(z_); ++i) {
    *outcome = UpdateBySelected();
    gate_.Expect(z_, at_, &filter_);
  }
  if (gate_.is_any_wrong() && gate_.Settle(measured_, &filter_)) {
    *outcome = UpdateBySelected();
    gate_.Expect(z_, at_, &filter_);
  }
  gate_.MoveOffsets(at_);
}

double S2kfConverter::ClippedDistance() {
  double sum = 0;
  int seen = 0;
  for (int m = 0; m < kinematics_.num_markers(); ++m) {
    estimate_.residuals[m] = (measured_.col(m) - at_.p_WM.col(m)).norm();
    const double distance = (z_.col(m) - at_.p_WM.col(m)).norm();
    if (!std::isfinite(distance)) continue;
    sum += std::min(distance, fit_options_.robust_distance);
    ++seen;
  }
  return sum / std::max(seen, 1);
}

const FrameEstimate& S2kfConverter::Assemble(const Ref<const Matrix3Xd>& frame) {
  const int seen = Gather(frame);
  if (seen < 3) {
    throw Error("only " + std::to_string(seen) +
                " of the mapped markers are seen in the first frame; at least 3 are needed");
  }
  std::fill(track_.hidden_for.begin(), track_.hidden_for.end(), 0.0);
  gate_.Reset();
  if (settings_.start == StartMethod::kPaper) {
    filter_.StartAsPaper(measured_, &track_.belief);
  } else {
    search_.Assemble(measured_, noise_scale_, fit_options_, settings_.start_attempts, &posture_);
    filter_.StartAt(posture_, &track_.belief);
  }
  const MarkerFilter::Outcome outcome = Update();
  track_.usual_distance = ClippedDistance();
  track_.doubt = kDoubtFrames;
  track_.far = false;
  FillEstimate(outcome, false);
  return estimate_;
}

bool S2kfConverter::IsInDoubt(double distance, double dt) {
  int returned = 0;
  for (std::size_t i = 0; i < track_.hidden_for.size(); ++i) {
    if (z_.col(i).allFinite()) {
      returned += track_.hidden_for[i] > kLongGap;
      track_.hidden_for[i] = 0;
    } else {
      track_.hidden_for[i] += dt;
    }
  }
  const double level = kDoubtFactor * track_.usual_distance;
  const bool rises = distance > level + kDoubtDistance;
  track_.far = distance > level + std::max(kDoubtDistance, settings_.marker_deviation);
  track_.doubt = rises || returned >= kManyReturned ? kDoubtFrames : std::max(track_.doubt - 1, 0);
  const double step = 1 - std::exp(-dt / kLevelTime);
  track_.usual_distance += step * (distance - track_.usual_distance);
  return track_.doubt > 0;
}

bool S2kfConverter::Recover() {
  PostureFit& fit = search_.fit();
  candidate_ = posture_;
  const PostureFit::Result before = fit.Evaluate(z_, noise_scale_, fit_options_, posture_);
  fit.Solve(z_, noise_scale_, fit_options_, &candidate_);
  search_.Improve(z_, noise_scale_, fit_options_, &candidate_);
  const PostureFit::Result after = fit.Evaluate(z_, noise_scale_, fit_options_, candidate_);
  if (after.cost > (1 - kClearlyBetter) * before.cost) return false;
  const double unseen = 1 - static_cast<double>(CountSeen(z_)) / static_cast<double>(z_.cols());
  const double least_gain =
      (settings_.smoothing ? 1 : std::min(1.0, 2 * unseen)) * settings_.marker_deviation;
  if (after.mean_distance > before.mean_distance - least_gain) return false;
  filter_.StartAt(candidate_, &track_.belief);
  return true;
}

bool S2kfConverter::Reopen() {
  const int left_out = gate_.CountLeftOut(measured_);
  if (!settings_.recovery || left_out < kManyLeftOut) return false;
  PostureFit& fit = search_.fit();
  candidate_ = posture_;
  fit.Solve(measured_, noise_scale_, fit_options_, &candidate_);
  const double all = fit.Evaluate(measured_, noise_scale_, fit_options_, candidate_).cost;
  const double used = fit.Evaluate(z_, noise_scale_, fit_options_, candidate_).cost;
  if ((all - used) * CountSeen(z_) > kAsWell * used * left_out) return false;
  filter_.StartAt(candidate_, &track_.belief);
  gate_.Open();
  return true;
}

const FrameEstimate& S2kfConverter::Track(const Ref<const Matrix3Xd>& frame, double dt) {
  const int seen = Gather(frame);
  filter_.Predict(dt, &track_.belief);
  gate_.Advance(dt);
  MarkerFilter::Outcome outcome = Update();
  bool reassembled = Reopen();
  if (reassembled) outcome = Update();
  const double distance = ClippedDistance();
  if (settings_.recovery && seen >= 3 && IsInDoubt(distance, dt) && !reassembled) {
    reassembled = Recover();
    if (reassembled) {
      gate_.Loosen();
      outcome = Update();
      track_.far = false;
      track_.usual_distance = std::min(track_.usual_distance, ClippedDistance());
    }
  }
  FillEstimate(outcome, reassembled);
  return estimate_;
}

void S2kfConverter::FillEstimate(const MarkerFilter::Outcome& outcome, bool reassembled) {
  filter_.Deviations(track_.belief, &deviations_);
  estimate_.posture.position = posture_.position;
  estimate_.posture.orientation = posture_.orientation;
  estimate_.standard_deviations.head<6>() = deviations_.head<6>();
  for (int j = 0; j < kinematics_.num_joints(); ++j) {
    const int joint = kinematics_.joints()[j];
    estimate_.posture.joint_angles[joint] = posture_.joint_angles[j];
    estimate_.standard_deviations[6 + joint] = deviations_[6 + j];
  }
  estimate_.markers_seen = outcome.seen;
  estimate_.markers_downweighted = outcome.downweighted;
  estimate_.verdicts = gate_.verdicts();
  estimate_.markers_wrong = 0;
  for (int m = 0; m < kinematics_.num_markers(); ++m) {
    if (measured_.col(m).allFinite()) {
      estimate_.markers_wrong += estimate_.verdicts[m] != kAsLabelled;
    } else {
      estimate_.verdicts[m] = kAsLabelled;
    }
  }
  estimate_.nis = outcome.nis;
  estimate_.reassembled = reassembled;
  estimate_.converged = outcome.seen > 0 && !track_.far;
}

}  // namespace mmm_converter::s2kf
