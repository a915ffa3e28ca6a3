// SPDX-License-Identifier: MIT
#include "plugins/s2kf/marker_gate.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <limits>

#include "plugins/s2kf/marker_filter.h"

namespace mmm_converter::s2kf {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

namespace {

// Standard deviation of an offset's coordinates before anything is known of it [m].
constexpr double kUnknownOffset = 0.04;
// The offset follows the residuals within this time [s]: what a marker does faster is a jump.
constexpr double kOffsetTime = 0.05;
// The usual offset follows within this time [s]; a marker that is farther from it than this [m] has
// wandered off.
constexpr double kUsualTime = 3;
constexpr double kFarOff = 0.12;
// It is not known before so many frames.
constexpr int kUsualFrames = 10;
// The offset of a hidden marker is unknown again after this time [s]: others that hide and return
// move the posture that it is beside.
constexpr double kHiddenTime = 0.3;
// And that of one left out: it may have another place on the body now.
constexpr double kLeftOutTime = 2;
// Of a residual about the offset: soft tissue and what the posture leaves [m].
constexpr double kResidual = 0.008;
// The worst go together with those within this share of them (squared distances): an estimate that
// is drawn away by wrong markers is far from right ones too.
constexpr double kWorstShare = 0.1;
// Two markers that are farther than this [m] from where they were expected before the frame, and
// whose exchange leaves no more than this share of that (squared), are swapped: seen before many
// such draw the estimate away.
constexpr double kFarSwap = 0.1;
constexpr double kSwapShare = 0.1;
// The estimate moves to what other markers make of it in so many frames.
constexpr int kSettlingFrames = 5;
// A marker that was left out before has to pass in so many frames in a row.
constexpr int kReadmitFrames = 3;

double AllowedDistance(double probability) {
  if (probability <= 0) return std::numeric_limits<double>::infinity();
  return quantile(complement(boost::math::chi_squared(3), probability));
}

}  // namespace

MarkerGate::MarkerGate(const MarkerKinematics& kinematics, double probability)
    : kinematics_(kinematics),
      allowed_(AllowedDistance(probability)),
      offset_W_(3, kinematics.num_markers()),
      usual_W_(3, kinematics.num_markers()),
      unoffset_(3 * kinematics.num_markers()),
      places_(3 * kinematics.num_markers()),
      expected_(3, kinematics.num_markers()),
      covariance_(kinematics.num_markers()),
      scores_(kinematics.num_markers()) {
  Reset();
}

void MarkerGate::Reset() {
  const int count = kinematics_.num_markers();
  now_.offset.setZero(3, count);
  now_.variance.setConstant(count, kUnknownOffset * kUnknownOffset);
  now_.usual.setZero(3, count);
  now_.learned.setZero(count);
  now_.verdicts.setConstant(count, -1);
  now_.agreed.setZero(count);
  now_.is_hidden.assign(count, false);
  now_.frames_since_change = 0;
}

void MarkerGate::Loosen() {
  for (int m = 0; m < now_.verdicts.size(); ++m) {
    if (now_.verdicts[m] != m) now_.variance[m] = kUnknownOffset * kUnknownOffset;
  }
}

int MarkerGate::CountLeftOut(const Matrix3Xd& measured) const {
  int count = 0;
  for (int m = 0; m < measured.cols(); ++m) {
    count += now_.verdicts[m] == m && measured.col(m).allFinite();
  }
  return count;
}

void MarkerGate::Open() {
  for (int m = 0; m < now_.verdicts.size(); ++m) {
    if (now_.verdicts[m] == m) now_.verdicts[m] = -1;
  }
  now_.learned.setZero();
  Loosen();
}

void MarkerGate::Advance(double dt) {
  ++now_.frames_since_change;
  // Such that the steady gain is that of kOffsetTime.
  const double gain = 1 - std::exp(-dt / kOffsetTime);
  const double drift = kResidual * kResidual * gain * gain / (1 - gain);
  usual_gain_ = 1 - std::exp(-dt / kUsualTime);
  const double unknown = kUnknownOffset * kUnknownOffset;
  for (int m = 0; m < now_.variance.size(); ++m) {
    const double growth = now_.is_hidden[m]       ? unknown * dt / kHiddenTime
                          : now_.verdicts[m] == m ? unknown * dt / kLeftOutTime
                                                  : drift;
    now_.variance[m] = std::min(unknown, now_.variance[m] + growth);
  }
}

void MarkerGate::Select(const Matrix3Xd& measured, Matrix3Xd* z) const {
  *z = measured;
  for (Eigen::Index m = 0; m < z->cols(); ++m) {
    if (now_.verdicts[m] == m) {
      z->col(m).setConstant(std::numeric_limits<double>::quiet_NaN());
    } else if (now_.verdicts[m] >= 0) {
      z->col(m) = measured.col(now_.verdicts[m]);
    }
  }
}

double MarkerGate::Score(const Vector3d& deviation, int m) const {
  Matrix3d S = covariance_[m];
  S.diagonal().array() += now_.variance[m] + kResidual * kResidual;
  return deviation.dot(S.llt().solve(deviation)) / allowed_;
}

bool MarkerGate::IsSuspicious(const Matrix3Xd& z, const MarkerJacobian& at) const {
  for (int m = 0; m < z.cols(); ++m) {
    const Matrix3d& R_WL = at.R_WL[kinematics_.link_of_marker(m)];
    const Vector3d r = R_WL.transpose() * (z.col(m) - at.p_WM.col(m));
    const double variance = now_.variance[m] + kResidual * kResidual;
    if ((r - now_.offset.col(m)).squaredNorm() > allowed_ * variance) return true;
    if (IsFarOff(r - now_.usual.col(m), m)) return true;
  }
  return false;
}

bool MarkerGate::IsFarOff(const Vector3d& from_usual, int m) const {
  return now_.learned[m] >= kUsualFrames && from_usual.norm() > kFarOff;
}

void MarkerGate::Expect(const Matrix3Xd& z, const MarkerJacobian& at, MarkerFilter* filter) {
  for (int m = 0; m < z.cols(); ++m) {
    offset_W_.col(m) = at.R_WL[kinematics_.link_of_marker(m)] * now_.offset.col(m);
    usual_W_.col(m) = at.R_WL[kinematics_.link_of_marker(m)] * now_.usual.col(m);
    covariance_[m].setZero();
  }
  unoffset_ = (z - offset_W_).reshaped();
  filter->Expect(unoffset_, &places_);
  expected_ = places_.reshaped(3, z.cols()) + offset_W_;
}

void MarkerGate::LeaveOut(int m) {
  const int other = now_.verdicts[m];
  for (const int i : {m, other}) {
    if (i < 0) continue;
    now_.verdicts[i] = i;
    now_.agreed[i] = kReadmitFrames;
  }
}

bool MarkerGate::ExchangeByPrior(const Matrix3Xd& measured, const MarkerJacobian& prior) {
  for (int m = 0; m < measured.cols(); ++m) {
    expected_.col(m) =
        prior.p_WM.col(m) + prior.R_WL[kinematics_.link_of_marker(m)] * now_.offset.col(m);
    const int label = now_.verdicts[m] < 0 ? m : now_.verdicts[m];
    scores_[m] = (measured.col(label) - expected_.col(m)).squaredNorm();
  }
  bool is_any = false;
  for (int a = 0; a < measured.cols(); ++a) {
    if (now_.verdicts[a] >= 0 || !(scores_[a] > kFarSwap * kFarSwap)) continue;
    for (int b = a + 1; b < measured.cols(); ++b) {
      if (now_.verdicts[b] >= 0 || !(scores_[b] > kFarSwap * kFarSwap)) continue;
      const double score_a = (measured.col(b) - expected_.col(a)).squaredNorm();
      const double score_b = (measured.col(a) - expected_.col(b)).squaredNorm();
      if (std::max(score_a, score_b) > kSwapShare * std::min(scores_[a], scores_[b])) continue;
      now_.verdicts[a] = b;
      now_.verdicts[b] = a;
      is_any = true;
      break;
    }
  }
  return is_any;
}

bool MarkerGate::LeaveOutWorst(const Matrix3Xd& z) {
  for (int m = 0; m < z.cols(); ++m) scores_[m] = z.col(m).allFinite() ? Score(z, m, m) : 0;
  const double least = std::max(1.0, kWorstShare * scores_.maxCoeff());
  bool is_any = false;
  for (int m = 0; m < z.cols(); ++m) {
    if (scores_[m] <= least) {
      if (!IsFarOff(z.col(m) - places_.segment<3>(3 * m) - usual_W_.col(m), m)) continue;
      // The offset has followed a marker that wandered off.
      now_.offset.col(m) = now_.usual.col(m);
    }
    LeaveOut(m);
    now_.frames_since_change = 0;
    is_any = true;
  }
  return is_any;
}

bool MarkerGate::Readmit(const Matrix3Xd& measured) {
  bool is_any = false;
  for (int m = 0; m < measured.cols(); ++m) {
    if (now_.verdicts[m] != m || !measured.col(m).allFinite()) continue;
    now_.agreed[m] = Score(measured, m, m) <= 1 ? now_.agreed[m] + 1 : 0;
    if (now_.agreed[m] < kReadmitFrames) continue;
    now_.verdicts[m] = -1;
    is_any = true;
  }
  return is_any;
}

bool MarkerGate::Exchange(const Matrix3Xd& measured) {
  const auto is_candidate = [&](int m) {
    return now_.verdicts[m] == m && now_.agreed[m] == 0 && measured.col(m).allFinite();
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
        const double score_a = Score(measured, b, a);
        const double score_b = Score(measured, a, b);
        if (score_a > 1 || score_b > 1 || score_a + score_b >= least) continue;
        least = score_a + score_b;
        first = a;
        second = b;
      }
    }
    if (first < 0) return is_any;
    now_.verdicts[first] = second;
    now_.verdicts[second] = first;
    is_any = true;
  }
}

bool MarkerGate::Settle(const Matrix3Xd& measured, MarkerFilter* filter) {
  int seen = 0;
  for (int m = 0; m < measured.cols(); ++m) {
    seen += measured.col(m).allFinite();
    if (now_.verdicts[m] == m) covariance_[m] = filter->ExpectedCovariance(m);
  }
  bool is_changed = Readmit(measured);
  is_changed |= Exchange(measured);
  if (2 * CountLeftOut(measured) <= seen) return is_changed;
  // Not the markers are wrong but the estimate is.
  Reset();
  return true;
}

void MarkerGate::MoveOffsets(const MarkerJacobian& at) {
  if (now_.frames_since_change > kSettlingFrames) return;
  for (int m = 0; m < now_.offset.cols(); ++m) {
    const Matrix3d& R_WL = at.R_WL[kinematics_.link_of_marker(m)];
    now_.offset.col(m) = R_WL.transpose() * (expected_.col(m) - at.p_WM.col(m));
  }
}

void MarkerGate::Learn(const Matrix3Xd& z, const MarkerJacobian& at) {
  for (int m = 0; m < z.cols(); ++m) {
    const bool was_hidden = now_.is_hidden[m];
    now_.is_hidden[m] = !z.col(m).allFinite() && now_.verdicts[m] != m;
    if (now_.is_hidden[m] != was_hidden) now_.frames_since_change = 0;
    if (!z.col(m).allFinite()) continue;
    const Matrix3d& R_WL = at.R_WL[kinematics_.link_of_marker(m)];
    const Vector3d r = R_WL.transpose() * (z.col(m) - at.p_WM.col(m));
    const double gain = now_.variance[m] / (now_.variance[m] + kResidual * kResidual);
    now_.offset.col(m) += gain * (r - now_.offset.col(m));
    now_.variance[m] *= 1 - gain;
    now_.usual.col(m) += std::max(usual_gain_, 1.0 / ++now_.learned[m]) * (r - now_.usual.col(m));
  }
}

}  // namespace mmm_converter::s2kf
