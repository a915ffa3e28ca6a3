// SPDX-License-Identifier: MIT
#include "plugins/s2kf/reported_covariance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/fit/posture_fit.h"
#include "common/math/dense.h"
#include "common/support/units.h"
#include "plugins/s2kf/posture_recovery.h"

namespace mmm_converter::s2kf {

using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

// Offsets are constant, so a second of residuals tells their size; over it, posture changes which
// of them show.
constexpr double kMemory = 1;  // [s]
// What is expected before counts as one measured coordinate beside the residuals.
constexpr double kPriorCoordinates = 1;
// Deviations are computed so often [s].
constexpr double kInterval = 0.075;
// What the pull to the natural posture weighs against one look at the markers, as a deviation in
// halves of a joint's range. The filter's pull has the information a / P, where a = dt q^2 / (2
// s^2) is the share by which it goes back in a frame and P at most s^2: with q = 0.17, s = 0.15, dt
// = 0.01 s that is 1.9^-2.
constexpr double kPullDeviation = 2;
constexpr double kLeastPull = 1e-4;
// What is expected of sizes before counts as so many that are measured.
constexpr double kPriorEffects = 2;
// Of the squares of residuals, at least, what sizes do not explain.
constexpr double kLeastOther = 0.25;
// Of an angle that may be anywhere in its range, in halves of the range.
constexpr double kUniformVariance = 1.0 / 3;
// Where the root can be at all [m, rad].
constexpr double kRootDeviation = 10;
constexpr double kFixedRoot = 1e-9;
constexpr double kFarAway = 1e3;  // not seen yet [s]

}  // namespace

ReportedCovariance::ReportedCovariance(const TrackedMarkers& markers, const S2kfSettings& settings)
    : kinematics_(markers.kinematics()),
      place_deviation_(markers.place_deviation()),
      told_deviation_(markers.told_deviation()),
      num_own_(static_cast<int>((told_deviation_.array() == 0).count())),
      noise_scale_(markers.noise_scale()),
      size_effects_(markers.size_effects()),
      settings_(settings.deviations),
      look_variance_(settings.marker_deviation * settings.marker_deviation),
      filter_variance_(
          look_variance_ *
          markers.FilterScale(settings.marker_deviation).cwiseQuotient(noise_scale_).squaredNorm() /
          kinematics_.num_markers()),
      prior_variance_(PriorVariance(settings)),
      clip_(FitOptions(settings).robust_distance),
      unit_(VectorXd::Ones(kinematics_.num_dofs())),
      middle_(VectorXd::Zero(kinematics_.num_joints())),
      spread_(VectorXd::Constant(kinematics_.num_joints(), kUniformVariance)),
      pull_(VectorXd::Zero(kinematics_.num_joints())),
      weights_(3 * kinematics_.num_markers(), 1),
      H_(kinematics_.num_dofs(), kinematics_.num_dofs()),
      root_(kinematics_.num_dofs(), kinematics_.num_dofs()),
      A_(kinematics_.num_dofs(), kinematics_.num_dofs()),
      moved_(3 * kinematics_.num_markers(), size_effects_.num_effects()),
      weighted_(3 * kinematics_.num_markers(), size_effects_.num_effects()),
      taken_(kinematics_.num_dofs(), size_effects_.num_effects()),
      of_sizes_(kinematics_.num_dofs(), size_effects_.num_effects()),
      kept_(size_effects_.num_effects(), 3 * kinematics_.num_markers()),
      kept_square_(size_effects_.num_effects(), size_effects_.num_effects()),
      kept_residual_(size_effects_.num_effects()) {
  const VectorXd natural = NaturalAngles(kinematics_);
  for (int j = 0; j < kinematics_.num_joints(); ++j) {
    const bool is_endless = kinematics_.IsEndless(j);
    const auto [lower, upper] = kinematics_.Range(j);
    unit_[6 + j] = is_endless ? std::numbers::pi : 0.5 * (upper - lower);
    if (is_endless) continue;
    middle_[j] = 0.5 * (upper + lower);
    const double natural_from_middle = (natural[j] - middle_[j]) / unit_[6 + j];
    spread_[j] += natural_from_middle * natural_from_middle;
  }
  deviations_.setConstant(kinematics_.num_dofs(), kNaN);
  Restart();
}

double ReportedCovariance::PriorVariance(const S2kfSettings& settings) const {
  // An object's model was made from its markers.
  const double offset = settings.deviations.marker_offset;
  const double unknown = kinematics_.num_joints() > 0 ? offset * offset : look_variance_;
  return place_deviation_.array()
      .isNaN()
      .select(unknown, VectorXd::Constant(place_deviation_.size(), look_variance_))
      .mean();
}

void ReportedCovariance::Restart() {
  last_residual_.setConstant(3, kinematics_.num_markers(), kNaN);
  age_.setConstant(kinematics_.num_markers(), kFarAway);
  frames_ = 0;
  since_compute_ = 0;
  squares_ = seen_ = step_squares_ = steps_ = 0;
  fitted_ = kinematics_.num_dofs();
  size_variance_ = 1;
  size_looks_ = size_squares_ = 0;
  white_share_ = 1;
}

void ReportedCovariance::Look(const Matrix3Xd& z, const MarkerJacobian& at, double dt) {
  double squares = 0;
  double step_squares = 0;
  int seen = 0;
  int steps = 0;
  for (Eigen::Index m = 0; m < z.cols(); ++m) {
    const Vector3d r_W = z.col(m) - at.p_WM.col(m);
    auto last = last_residual_.col(m);
    // Comparisons with NaN are false.
    if (!(r_W.squaredNorm() <= clip_ * clip_)) {
      age_[m] += dt;
      last.setConstant(kNaN);
      continue;
    }
    const Eigen::Matrix3d& R_WL = at.R_WL[kinematics_.link_of_marker(static_cast<int>(m))];
    const Vector3d r = R_WL.transpose() * r_W / noise_scale_[m];
    const double step = (r - last).squaredNorm();
    age_[m] = 0;
    last = r;
    if (told_deviation_[m] > 0) continue;
    if (std::isfinite(step)) {
      step_squares += 0.5 * step;
      steps += 3;
    }
    squares += r.squaredNorm();
    seen += 3;
  }
  ++frames_;
  since_compute_ += dt;
  const double gain = std::max(std::min(1.0, dt / kMemory), 1.0 / frames_);
  squares_ += gain * (squares - squares_);
  seen_ += gain * (seen - seen_);
  step_squares_ += gain * (step_squares - step_squares_);
  steps_ += gain * (steps - steps_);
}

void ReportedCovariance::EstimateVariances() {
  const double open = std::max(0.0, seen_ - fitted_);
  const double total = (kPriorCoordinates * prior_variance_ +
                        std::max(squares_ - size_squares_, kLeastOther * squares_)) /
                       (kPriorCoordinates + open);
  double share = 0;  // that changes from frame to frame
  if (steps_ > 0 && squares_ > 0) {
    share = std::min(1.0, (step_squares_ / steps_) / (squares_ / seen_));
  }
  white_ = share * total;
  slow_ = (1 - share) * total;
}

void ReportedCovariance::Invert(const VectorXd* until_look, const MarkerJacobian& at) {
  const int n = kinematics_.num_dofs();
  const int num_markers = kinematics_.num_markers();
  variance_ = 0;
  for (int m = 0; m < num_markers; ++m) {
    const double place = place_deviation_[m];
    const double scale = noise_scale_[m] * noise_scale_[m];
    const double hidden_from_residuals = size_effects_.num_effects() > 0 ? 0.0
                                         : std::isnan(place)
                                             ? settings_.length_share * scale * slow_
                                             : place * place;
    const double variance = scale * (slow_ + white_share_ * white_) + hidden_from_residuals +
                            told_deviation_[m] * told_deviation_[m];
    double age = age_[m];
    if (until_look != nullptr && age > 0) {
      // Known from both sides: the information of the two ways adds.
      const double until = (*until_look)[m];
      age *= until / std::hypot(age, until);
    }
    const double way = settings_.limb_speed * age;
    weights_.view().col(0).segment<3>(3 * m).setConstant(1 / (variance + way * way));
    if (told_deviation_[m] > 0) continue;
    variance_ += variance / num_own_;
  }
  // What draws an estimate that follows its markers is weak; one that follows none is where it was
  // or natural, whichever is known better.
  const double weak =
      std::max(kLeastPull, look_variance_ / (variance_ * kPullDeviation * kPullDeviation));
  for (int j = 0; j < n - 6; ++j) pull_[j] = IsShown(j) ? weak : 1 / spread_[j];
  const double root_deviation = kinematics_.is_root_fixed() ? kFixedRoot : kRootDeviation;
  H_.SetZero();
  AddWeightedSquare(at.J_transposed, weights_, &H_);
  auto H = H_.view();
  for (int j = 0; j < n; ++j) {
    for (int i = j; i < n; ++i) H(i, j) *= unit_[i] * unit_[j];
    H(j, j) += j < 6 ? 1 / (root_deviation * root_deviation) : pull_[j - 6];
  }
  Factorize(&H_);
  root_.SetIdentity();
  DivideByTransposed(H_, &root_);
  A_.SetZero();
  AddSquare(1, root_, &A_);
  auto A = A_.view();
  A.triangularView<Eigen::StrictlyUpper>() = A.transpose();
  fitted_ = n - pull_.dot(A.diagonal().tail(n - 6));
}

void ReportedCovariance::AddSizes(const MarkerJacobian& at) {
  size_effects_.Compute(at, &moved_);
  const auto weights = weights_.view().col(0);
  weighted_.view() = weights.asDiagonal() * moved_.view();
  Multiply(1, at.J_transposed, weighted_, &taken_);
  auto taken = taken_.view();
  taken.array().colwise() *= unit_.array();
  Multiply(1, A_, taken_, &of_sizes_);
  taken = unit_.asDiagonal() * of_sizes_.view();  // now in the units of states
  const auto J_transposed = at.J_transposed.view();
  kept_.SetZero();
  for (int m = 0; m < kinematics_.num_markers(); ++m) {
    if (age_[m] > 0 || told_deviation_[m] > 0) continue;
    auto kept = kept_.view().middleCols<3>(3 * m);
    kept = moved_.view().middleRows<3>(3 * m).transpose();
    kept.noalias() -= taken.transpose() * J_transposed.middleCols<3>(3 * m);
    kept /= noise_scale_[m];
  }
  EstimateSizeVariance(at);
}

void ReportedCovariance::EstimateSizeVariance(const MarkerJacobian& at) {
  // By moments: residuals are r = K^T s + e, with s of variance f and e of variance v in n open
  // coordinates. With G = K K^T: E |r|^2 = f tr G + v n, E |K r|^2 = f tr G^2 + v tr G.
  kept_residual_.setZero();
  double squares = 0;
  double seen = 0;
  for (int m = 0; m < kinematics_.num_markers(); ++m) {
    if (age_[m] > 0 || told_deviation_[m] > 0) continue;
    const Vector3d r = at.R_WL[kinematics_.link_of_marker(m)] * last_residual_.col(m);
    kept_residual_.noalias() += kept_.view().middleCols<3>(3 * m) * r;
    squares += r.squaredNorm();
    seen += 3;
  }
  kept_square_.SetZero();
  AddSquare(1, kept_, &kept_square_);
  const auto G = kept_square_.view();
  double trace = 0;
  double square = 0;
  for (Eigen::Index i = 0; i < G.cols(); ++i) {
    trace += G(i, i);
    square += 2 * G.col(i).tail(G.rows() - i).squaredNorm() - G(i, i) * G(i, i);
  }
  const double open = seen - fitted_;
  const double unlike = open * square - trace * trace;
  if (open > 0 && unlike > 0) {
    const double found =
        std::max(0.0, (open * kept_residual_.squaredNorm() - trace * squares) / unlike);
    const double effects = trace * trace / square;
    const double now = (kPriorEffects + effects * found) / (kPriorEffects + effects);
    size_variance_ += (now - size_variance_) / ++size_looks_;
  }
  size_squares_ = size_variance_ * trace;
}

bool ReportedCovariance::IsShown(int joint) const {
  for (int m = 0; m < kinematics_.num_markers(); ++m) {
    if (age_[m] == 0 && kinematics_.Moves(joint, m)) return true;
  }
  return false;
}

double ReportedCovariance::VarianceOf(int i, const VectorXd& angles) const {
  const auto A = A_.view();
  double variance = A(i, i);
  for (Eigen::Index j = 0; j < pull_.size(); ++j) {
    variance -= pull_[j] * (1 - pull_[j] * spread_[j]) * A(6 + j, i) * A(6 + j, i);
  }
  variance += size_variance_ * of_sizes_.view().row(i).squaredNorm();
  if (i < 6) return variance;
  if (kinematics_.IsEndless(i - 6)) return variance * unit_[i] * unit_[i];
  // Nor can it be farther off than an angle that is anywhere in the range.
  const double from_middle = (angles[i - 6] - middle_[i - 6]) / unit_[i];
  const double anywhere = kUniformVariance + from_middle * from_middle;
  return variance * anywhere / (variance + anywhere) * unit_[i] * unit_[i];
}

MatrixXd ReportedCovariance::Covariance() const {
  const Eigen::Index joints = pull_.size();
  const MatrixXd A = A_.view();
  const VectorXd pulled =
      pull_.array() * (1 - pull_.array() * spread_.array());  // N - N S N, of the joints
  const auto of_joints = A.rightCols(joints);
  MatrixXd P = A - of_joints * pulled.asDiagonal() * of_joints.transpose();
  P += size_variance_ * of_sizes_.view() * of_sizes_.view().transpose();
  // What bounds a deviation leaves the correlations as they are.
  const VectorXd scale = deviations_.array() / P.diagonal().array().sqrt();
  P = scale.asDiagonal() * P * scale.asDiagonal();
  return 0.5 * (P + P.transpose());
}

double ReportedCovariance::ShareOf(const VectorXd& own) const {
  const auto A = A_.view();
  const double look = filter_variance_ / variance_;
  constexpr double kResting = 1e-6;  // of a joint that no marker shows [rad]
  double sum = 0;
  int count = 0;
  for (Eigen::Index i = 0; i < own.size(); ++i) {
    if (own[i] < kResting) continue;
    const double of_look = look * A(i, i) * unit_[i] * unit_[i];
    sum += std::min(1.0, own[i] * own[i] / of_look);
    ++count;
  }
  return count > 0 ? sum / count : 1;
}

bool ReportedCovariance::IsDue() const { return frames_ <= 2 || since_compute_ >= kInterval; }

void ReportedCovariance::Compute(const VectorXd& angles, const VectorXd& own, MarkerJacobian* at,
                                 const VectorXd* until_look) {
  since_compute_ = 0;
  EstimateVariances();
  kinematics_.ComputeJacobian(at);
  Invert(until_look, *at);
  if (size_effects_.num_effects() > 0) AddSizes(*at);
  white_share_ = ShareOf(own);
  for (int i = 0; i < kinematics_.num_dofs(); ++i) {
    deviations_[i] = std::sqrt(VarianceOf(i, angles));
  }
}

}  // namespace mmm_converter::s2kf
