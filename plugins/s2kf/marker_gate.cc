// SPDX-License-Identifier: MIT
#include "plugins/s2kf/marker_gate.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <limits>

namespace mmm_converter::s2kf {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

namespace {

// The worst go together with those within this share of them (squared distances): an estimate that
// is drawn away by wrong markers is far from right ones too.
constexpr double kWorstShare = 0.1;
// A marker that is farther than this [m] from where it was expected before the frame, and nearest
// to another's place, of which it leaves no more than this share (squared), is swapped with that
// one, which may be hidden: seen before many such draw the estimate away.
constexpr double kFarSwap = 0.1;
constexpr double kSwapShare = 0.1;
// Where so many pairs of the same two limbs are swapped, others of these need not be farther than
// this [m]: feet stand beside each other.
constexpr int kLimbPairs = 3;
constexpr double kNearSwap = 0.01;
// The estimate moves to what other markers make of it in so many frames.
constexpr int kSettlingFrames = 5;
// A marker that was left out before has to pass in so many frames in a row.
constexpr int kReadmitFrames = 3;

double AllowedDistance(double probability) {
  if (probability <= 0) return std::numeric_limits<double>::infinity();
  return quantile(complement(boost::math::chi_squared(3), probability));
}

void LeaveOut(int m, GateState* state) {
  const int other = state->verdicts[m];
  for (const int i : {m, other}) {
    if (i < 0) continue;
    state->verdicts[i] = i;
    state->agreed[i] = kReadmitFrames;
  }
}

}  // namespace

MarkerGate::MarkerGate(const MarkerKinematics& kinematics, std::vector<int> mirror,
                       double probability)
    : kinematics_(kinematics),
      mirror_(std::move(mirror)),
      allowed_(AllowedDistance(probability)),
      scratch_(kinematics.num_dofs(), 3 * kinematics.num_markers()),
      offset_W_(3, kinematics.num_markers()),
      usual_W_(3, kinematics.num_markers()),
      unoffset_(3 * kinematics.num_markers()),
      places_(3 * kinematics.num_markers()),
      expected_(3, kinematics.num_markers()),
      covariance_(kinematics.num_markers()),
      scores_(kinematics.num_markers()),
      nearest_(kinematics.num_markers()),
      moved_(3, kinematics.num_markers()) {}

double MarkerGate::Score(const GateState& state, const Matrix3Xd& points, int point, int m) const {
  const Vector3d deviation = points.col(point) - expected_.col(m);
  Matrix3d S = covariance_[m];
  S.diagonal().array() += state.VarianceOfResidual(m);
  return deviation.dot(S.llt().solve(deviation)) / allowed_;
}

bool MarkerGate::IsSuspicious(const GateState& state, const Matrix3Xd& z,
                              const MarkerJacobian& at) const {
  for (int m = 0; m < z.cols(); ++m) {
    const Matrix3d& R_WL = at.R_WL[kinematics_.link_of_marker(m)];
    const Vector3d r = R_WL.transpose() * (z.col(m) - at.p_WM.col(m));
    const double variance = state.VarianceOfResidual(m);
    if ((r - state.offset.col(m)).squaredNorm() > allowed_ * variance) return true;
    if (state.IsFarOff(r - state.usual.col(m), m)) return true;
  }
  return false;
}

void MarkerGate::Expect(const GateState& state, const Matrix3Xd& z, const MarkerJacobian& at,
                        const UpdateOutcome& outcome) {
  for (int m = 0; m < z.cols(); ++m) {
    offset_W_.col(m) = at.R_WL[kinematics_.link_of_marker(m)] * state.offset.col(m);
    usual_W_.col(m) = at.R_WL[kinematics_.link_of_marker(m)] * state.usual.col(m);
    covariance_[m].setZero();
  }
  unoffset_ = (z - offset_W_).reshaped();
  outcome.PosteriorPlaces(unoffset_, &scratch_, &places_);
  expected_ = places_.reshaped(3, z.cols()) + offset_W_;
}

void MarkerGate::ExpectByPrior(const MarkerJacobian& prior, const Matrix3Xd& offsets) {
  for (int m = 0; m < expected_.cols(); ++m) {
    const Matrix3d& R_WL = prior.R_WL[kinematics_.link_of_marker(m)];
    expected_.col(m) = prior.p_WM.col(m) + R_WL * offsets.col(m);
  }
}

void MarkerGate::Reconsider(const Matrix3Xd& measured, const MarkerJacobian& prior,
                            GateState* state) {
  ExpectByPrior(prior, state->usual);
  for (int a = 0; a < measured.cols(); ++a) {
    const int b = state->verdicts[a];
    if (b <= a) continue;
    double labelled = 0;
    double exchanged = 0;
    for (const auto& [label, other] : {std::pair(a, b), std::pair(b, a)}) {
      if (!measured.col(label).allFinite()) continue;
      labelled += (measured.col(label) - expected_.col(label)).squaredNorm();
      exchanged += (measured.col(label) - expected_.col(other)).squaredNorm();
    }
    if (exchanged == 0 || exchanged < labelled) continue;
    state->verdicts[a] = -1;
    state->verdicts[b] = -1;
  }
}

bool MarkerGate::ExchangeByPrior(const Matrix3Xd& measured, const MarkerJacobian& prior,
                                 GateState* state) {
  ExpectByPrior(prior, state->offset);
  const bool is_any = ExchangeBeyond(kFarSwap, 0, measured, state);
  FollowExchanged(measured, state->verdicts);
  return ExchangeBeyond(kNearSwap, kLimbPairs, measured, state) || is_any;
}

bool MarkerGate::IsOnLimb(int other, int marker, int beyond) const {
  for (int j = 0; j < kinematics_.num_joints(); ++j) {
    if (kinematics_.Moves(j, other) && kinematics_.Moves(j, marker) &&
        !kinematics_.Moves(j, beyond)) {
      return true;
    }
  }
  return false;
}

void MarkerGate::FollowExchanged(const Matrix3Xd& measured, const Eigen::VectorXi& verdicts) {
  moved_.setZero();
  for (int m = 0; m < moved_.cols(); ++m) {
    int count = 0;
    for (int c = 0; c < verdicts.size(); ++c) {
      const int d = verdicts[c];
      if (d < 0 || d == c || !measured.col(d).allFinite() || !IsOnLimb(c, m, d)) continue;
      moved_.col(m) += (measured.col(d) - expected_.col(c) - moved_.col(m)) / ++count;
    }
  }
  expected_ += moved_;
}

int MarkerGate::CountOfSameLimbs(int a, int b, const Eigen::VectorXi& verdicts) const {
  int count = 0;
  for (int c = 0; c < verdicts.size(); ++c) {
    const int d = verdicts[c];
    count += d >= 0 && d != c && IsOnLimb(c, a, b) && IsOnLimb(d, b, a);
  }
  return count;
}

bool MarkerGate::ExchangeBeyond(double least, int limb_pairs, const Matrix3Xd& measured,
                                GateState* state) {
  Eigen::VectorXi& verdicts = state->verdicts;
  for (int label = 0; label < measured.cols(); ++label) {
    nearest_[label] = -1;
    if (verdicts[label] >= 0 || !measured.col(label).allFinite()) continue;
    const auto squared = (expected_.colwise() - measured.col(label)).colwise().squaredNorm();
    if (squared[label] < least * least) continue;
    const int mirror = mirror_[label];
    Eigen::Index nearest = mirror;
    if (mirror < 0 || squared[mirror] > kSwapShare * squared[label]) squared.minCoeff(&nearest);
    if (squared[nearest] > kSwapShare * squared[label]) continue;
    nearest_[label] = static_cast<int>(nearest);
  }
  bool is_any = false;
  for (int a = 0; a < measured.cols(); ++a) {
    const int b = nearest_[a];
    if (b < 0 || verdicts[a] >= 0 || verdicts[b] >= 0) continue;
    if (measured.col(b).allFinite() && nearest_[b] != a) continue;
    if (CountOfSameLimbs(a, b, verdicts) < limb_pairs) continue;
    verdicts[a] = b;
    verdicts[b] = a;
    is_any = true;
  }
  return is_any;
}

bool MarkerGate::LeaveOutWorst(const Matrix3Xd& z, GateState* state) {
  for (int m = 0; m < z.cols(); ++m) {
    scores_[m] = z.col(m).allFinite() ? Score(*state, z, m, m) : 0;
  }
  const double least = std::max(1.0, kWorstShare * scores_.maxCoeff());
  bool is_any = false;
  for (int m = 0; m < z.cols(); ++m) {
    if (scores_[m] <= least) {
      if (!state->IsFarOff(z.col(m) - places_.segment<3>(3 * m) - usual_W_.col(m), m)) continue;
      // The offset has followed a marker that wandered off.
      state->offset.col(m) = state->usual.col(m);
    }
    LeaveOut(m, state);
    state->frames_since_change = 0;
    is_any = true;
  }
  return is_any;
}

bool MarkerGate::Readmit(const Matrix3Xd& measured, GateState* state) const {
  bool is_any = false;
  for (int m = 0; m < measured.cols(); ++m) {
    if (!state->IsLeftOut(m) || !measured.col(m).allFinite()) continue;
    const auto usual = places_.segment<3>(3 * m) + usual_W_.col(m);
    const bool is_far_off = state->IsFarOff(measured.col(m) - usual, m, covariance_[m].trace() / 3);
    const bool passes = Score(*state, measured, m, m) <= 1;
    int& agreed = state->agreed[m];
    agreed = passes && !(is_far_off && state->IsPlaceKnown(m)) ? agreed + 1 : 0;
    if (agreed < kReadmitFrames) continue;
    state->verdicts[m] = -1;
    is_any = true;
    // It was attached anew.
    if (is_far_off && state->is_calibrated[m]) state->learned[m] = 0;
  }
  return is_any;
}

bool MarkerGate::Exchange(const Matrix3Xd& measured, GateState* state) const {
  const auto is_candidate = [&](int m) {
    return state->IsLeftOut(m) && state->agreed[m] == 0 && measured.col(m).allFinite();
  };
  bool is_any = false;
  for (;;) {
    double least = 2;
    int first = -1;
    int second = -1;
    for (int a = 0; a < measured.cols(); ++a) {
      if (!is_candidate(a)) continue;
      for (int b = a + 1; b < measured.cols(); ++b) {
        if (!is_candidate(b)) continue;
        const double score_a = Score(*state, measured, b, a);
        const double score_b = Score(*state, measured, a, b);
        if (score_a > 1 || score_b > 1 || score_a + score_b >= least) continue;
        least = score_a + score_b;
        first = a;
        second = b;
      }
    }
    if (first < 0) return is_any;
    state->verdicts[first] = second;
    state->verdicts[second] = first;
    is_any = true;
  }
}

bool MarkerGate::Settle(const Matrix3Xd& measured, const UpdateOutcome& outcome, GateState* state) {
  int seen = 0;
  for (int m = 0; m < measured.cols(); ++m) {
    seen += measured.col(m).allFinite();
    if (state->IsLeftOut(m)) covariance_[m] = outcome.PosteriorCovariance(m, &scratch_);
  }
  bool is_changed = Readmit(measured, state);
  is_changed |= Exchange(measured, state);
  if (2 * state->CountLeftOut(measured) <= seen) return is_changed;
  // Not the markers are wrong but the estimate is.
  state->Reset();
  return true;
}

void MarkerGate::MoveOffsets(const MarkerJacobian& at, GateState* state) const {
  if (state->frames_since_change > kSettlingFrames) return;
  for (int m = 0; m < state->offset.cols(); ++m) {
    if (state->learned[m] == 0) continue;
    const Matrix3d& R_WL = at.R_WL[kinematics_.link_of_marker(m)];
    state->offset.col(m) = R_WL.transpose() * (expected_.col(m) - at.p_WM.col(m));
  }
}

void MarkerGate::Learn(const Matrix3Xd& z, const MarkerJacobian& at, GateState* state) const {
  for (int m = 0; m < z.cols(); ++m) {
    const bool was_hidden = state->is_hidden[m];
    state->is_hidden[m] = !z.col(m).allFinite() && !state->IsLeftOut(m);
    if (state->is_hidden[m] != was_hidden) state->frames_since_change = 0;
    if (!z.col(m).allFinite()) continue;
    const Matrix3d& R_WL = at.R_WL[kinematics_.link_of_marker(m)];
    state->Learn(m, R_WL.transpose() * (z.col(m) - at.p_WM.col(m)));
  }
}

}  // namespace mmm_converter::s2kf
