// SPDX-License-Identifier: MIT
#include "common/calibrate/offset_prior.h"

#include <algorithm>
#include <cmath>

#include "common/calibrate/robust_cost.h"

namespace mmm_converter {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::Vector3d;

namespace {

// Of a marker's offset, in marker_deviations, where it begins to count less.
constexpr double kOffsetScale = 2;
// Of a marker on one side of a joint, as a share of marker_deviation across the line to that on the
// other: both are palpated, and the joint is between them (Della Croce et al. 2005).
constexpr double kPairShare = 0.5;
constexpr double kMostCorrelation = 0.95;
// What is assumed of the correlation counts as much as so many coordinates of pairs.
constexpr double kAssumedCoordinates = 3;

/// Makes an offset one of three coordinates of variance 1.
Matrix3d Whitening(const Matrix3Xd& lines, Index m, double deviation) {
  Matrix3d whitening = Matrix3d::Identity();
  if (m < lines.cols() && !lines.col(m).isZero(0)) {
    whitening +=
        (1 / kPairShare - 1) * (Matrix3d::Identity() - lines.col(m) * lines.col(m).transpose());
  }
  return whitening / deviation;
}

}  // namespace

OffsetPrior::OffsetPrior(const BodyKinematics& kinematics, const CalibrationOptions& options,
                         const Eigen::VectorXd& deviations)
    : correlation_(options.side_correlation) {
  const auto whitening = [&](Index m) { return Whitening(kinematics.lines(), m, deviations[m]); };
  std::vector<bool> is_mirrored(kinematics.markers().size(), false);
  for (const MirroredPlaces& pair : kinematics.mirrors()) {
    is_mirrored[pair.a] = is_mirrored[pair.b] = true;
    const Mirrored both = {pair.a, pair.b, whitening(pair.a),
                           pair.R_ba.transpose() * whitening(pair.b)};
    mirrored_.push_back(both);
    // Their sum and difference are independent.
    for (const double sign : {1.0, -1.0}) {
      const double scale = 1 / std::sqrt(2 * (1 + sign * correlation_));
      terms_.push_back({both.a, both.b, scale * both.A, sign * scale * both.B});
    }
  }
  for (Index m = 0; m < static_cast<Index>(is_mirrored.size()); ++m) {
    if (!is_mirrored[m]) terms_.push_back({m, -1, whitening(m), Matrix3d::Zero()});
  }
}

Vector3d OffsetPrior::Term::Of(const Matrix3Xd& offsets) const {
  Vector3d v = A * offsets.col(a);
  if (b >= 0) v += B * offsets.col(b);
  return v;
}

double OffsetPrior::Cost(const Matrix3Xd& offsets) const {
  double cost = 0;
  for (const Term& term : terms_) cost += CauchyCost(term.Of(offsets).squaredNorm(), kOffsetScale);
  return cost;
}

void OffsetPrior::Add(const Matrix3Xd& offsets, BodyEquations* body) const {
  auto H = body->H.view();
  const auto add = [&](Index i, Index k, const Matrix3d& block) {
    H.block<3, 3>(3 * i, 3 * k) += block;  // the lower triangle counts
  };
  for (const Term& term : terms_) {
    const Vector3d v = term.Of(offsets);
    const double w = CauchyWeight(v.squaredNorm(), kOffsetScale);
    add(term.a, term.a, w * term.A.transpose() * term.A);
    body->g.segment<3>(3 * term.a) -= w * term.A.transpose() * v;
    if (term.b < 0) continue;
    add(term.b, term.b, w * term.B.transpose() * term.B);
    body->g.segment<3>(3 * term.b) -= w * term.B.transpose() * v;
    const Matrix3d mixed = w * term.A.transpose() * term.B;
    if (term.a > term.b) {
      add(term.a, term.b, mixed);
    } else {
      add(term.b, term.a, mixed.transpose());
    }
  }
}

double OffsetPrior::LikelyCorrelation(const Matrix3Xd& offsets, const MatrixXd& covariance) const {
  double together = correlation_ * kAssumedCoordinates, own = kAssumedCoordinates;
  for (const Mirrored& one : mirrored_) {
    const Vector3d a = one.A * offsets.col(one.a), b = one.B * offsets.col(one.b);
    const auto block = [&](Index i, Index k) { return covariance.block<3, 3>(3 * i, 3 * k); };
    const double square = 0.5 * (a.squaredNorm() + b.squaredNorm());
    const double w = CauchyWeight(square, kOffsetScale);
    together += w * (a.dot(b) + (one.A * block(one.a, one.b) * one.B.transpose()).trace());
    own += w * (square + 0.5 * ((one.A * block(one.a, one.a) * one.A.transpose()).trace() +
                                (one.B * block(one.b, one.b) * one.B.transpose()).trace()));
  }
  return std::clamp(together / own, 0.0, kMostCorrelation);
}

}  // namespace mmm_converter
