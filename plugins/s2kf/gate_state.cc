// SPDX-License-Identifier: MIT
#include "plugins/s2kf/gate_state.h"

#include <algorithm>
#include <cmath>

#include "common/support/units.h"

namespace mmm_converter::s2kf {

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
// Of a marker that was calibrated: what its skin was measured to do, but at least this [m]. It is
// then far off, too, beyond so many times that, as its usual place moves with nothing else.
constexpr double kLeastResidual = 0.004;
constexpr double kFarInResiduals = 6;

}  // namespace

void GateState::Start(const Eigen::VectorXd& skin_deviation) {
  residual.setConstant(skin_deviation.size(), kResidual);
  is_calibrated.assign(skin_deviation.size(), false);
  for (int m = 0; m < residual.size(); ++m) {
    if (std::isnan(skin_deviation[m])) continue;
    is_calibrated[m] = true;
    residual[m] = std::clamp(skin_deviation[m], kLeastResidual, kResidual);
  }
  Reset();
}

void GateState::Reset() {
  const Eigen::Index num_markers = residual.size();
  offset.setZero(3, num_markers);
  variance.setConstant(num_markers, kUnknownOffset * kUnknownOffset);
  usual.setZero(3, num_markers);
  learned.setZero(num_markers);
  verdicts.setConstant(num_markers, -1);
  agreed.setZero(num_markers);
  left_out_for.setZero(num_markers);
  is_hidden.assign(num_markers, false);
  frames_since_change = 0;
}

void GateState::Loosen() {
  for (int m = 0; m < verdicts.size(); ++m) {
    if (!IsLeftOut(m)) variance[m] = kUnknownOffset * kUnknownOffset;
  }
}

void GateState::Open() {
  for (int m = 0; m < verdicts.size(); ++m) {
    if (!IsLeftOut(m)) continue;
    verdicts[m] = -1;
    offset.col(m).setZero();
  }
  learned.setZero();
}

void GateState::Advance(double dt) {
  ++frames_since_change;
  // Such that the steady gain is that of kOffsetTime.
  const double gain = 1 - std::exp(-dt / kOffsetTime);
  const double drift = gain * gain / (1 - gain);
  usual_gain = 1 - std::exp(-dt / kUsualTime);
  const double unknown = kUnknownOffset * kUnknownOffset;
  for (int m = 0; m < variance.size(); ++m) {
    left_out_for[m] = IsLeftOut(m) ? left_out_for[m] + dt : 0;
    double growth = drift * residual[m] * residual[m];
    if (is_hidden[m]) {
      growth = unknown * dt / kHiddenTime;
    } else if (IsLeftOut(m) && !IsPlaceKnown(m)) {
      growth = is_calibrated[m] ? unknown : unknown * dt / kLeftOutTime;
    }
    variance[m] = std::min(unknown, variance[m] + growth);
  }
}

int GateState::CountLeftOut(const Matrix3Xd& measured) const {
  int count = 0;
  for (int m = 0; m < measured.cols(); ++m) {
    count += IsLeftOut(m) && measured.col(m).allFinite();
  }
  return count;
}

void GateState::Select(const Matrix3Xd& measured, Matrix3Xd* relabelled, Matrix3Xd* z) const {
  for (int m = 0; m < z->cols(); ++m) {
    relabelled->col(m) = measured.col(verdicts[m] < 0 ? m : verdicts[m]);
    z->col(m) = relabelled->col(m);
    if (IsLeftOut(m)) z->col(m).setConstant(kNaN);
  }
}

double GateState::VarianceOfResidual(int m) const {
  return variance[m] + residual[m] * residual[m];
}

bool GateState::IsPlaceKnown(int m) const {
  return is_calibrated[m] && left_out_for[m] < kLeftOutTime;
}

bool GateState::IsFarOff(const Vector3d& from_usual, int m, double place_variance) const {
  // One that comes back after it was hidden shows where its limb is.
  const double limit =
      !is_calibrated[m] || is_hidden[m]
          ? kFarOff
          : kFarInResiduals * std::sqrt(residual[m] * residual[m] + place_variance);
  return learned[m] >= kUsualFrames && from_usual.norm() > limit;
}

void GateState::Learn(int m, const Vector3d& r) {
  const double gain = variance[m] / VarianceOfResidual(m);
  offset.col(m) += gain * (r - offset.col(m));
  variance[m] *= 1 - gain;
  if (verdicts[m] >= 0) return;
  usual.col(m) += std::max(usual_gain, 1.0 / ++learned[m]) * (r - usual.col(m));
}

}  // namespace mmm_converter::s2kf
