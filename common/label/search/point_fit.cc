// SPDX-License-Identifier: MIT
#include "common/label/search/point_fit.h"

#include <cmath>

#include "common/support/units.h"

namespace mmm_converter {

using Eigen::Matrix3Xd;
using Eigen::Ref;
using Eigen::VectorXd;

void PointFit::Anneal(const Ref<const Matrix3Xd>& points, const Annealing& annealing,
                      MovingBody* body, Posture* posture) {
  const auto& [from, to, steps] = annealing;
  for (int i = 0; i < steps; ++i) {
    const double spread = from * std::pow(to / from, i / (steps - 1.0));
    const VectorXd& variances = body->Variances(spread);
    soft_.Compute(body->Place(*posture), variances, points);
    noise_ = (variances.array() / soft_.weights().array().max(FitTuning::kLeastWeight)).sqrt();
    body->Step(soft_.targets(), noise_, posture);
  }
}

double PointFit::Assign(const Ref<const Matrix3Xd>& points, double spread, const Posture& posture,
                        MovingBody* body) {
  const Matrix3Xd& places = body->Place(posture);
  const VectorXd& variances = body->Variances(spread);
  costs_.resize(places.cols(), points.cols());
  for (Eigen::Index m = 0; m < places.cols(); ++m) {
    costs_.row(m) = (points.colwise() - places.col(m)).colwise().squaredNorm() / variances[m];
  }
  point_of_marker_ = assignment_.Solve(costs_, MatchCosts::kUnmatched);
  return assignment_.cost() + body->PostureCost(posture);
}

double PointFit::Settle(const Ref<const Matrix3Xd>& points, const Turns& turns, MovingBody* body,
                        Posture* posture) {
  double cost = Assign(points, turns.spread, *posture, body);
  for (int turn = 0; turn < turns.most; ++turn) {
    targets_.setConstant(3, costs_.rows(), kNaN);
    for (Eigen::Index m = 0; m < targets_.cols(); ++m) {
      const int point = point_of_marker_[m];
      if (point >= 0) targets_.col(m) = points.col(point);
    }
    noise_ = body->Variances(turns.spread).array().sqrt();
    points_before_ = point_of_marker_;
    before_ = *posture;
    body->Step(targets_, noise_, posture);
    const double next = Assign(points, turns.spread, *posture, body);
    const double gain = cost - next;
    if (gain <= 0 && turns.keeps_cheapest) {
      point_of_marker_ = points_before_;
      *posture = before_;
      return cost;
    }
    cost = next;
    if (gain < FitTuning::kLeastGain) break;
  }
  return cost;
}

}  // namespace mmm_converter
