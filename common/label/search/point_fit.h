// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/label/search/linear_assignment.h"
#include "common/label/search/moving_body.h"
#include "common/label/search/soft_assignment.h"
#include "common/label/tuning.h"
#include "common/model/posture.h"

namespace mmm_converter {

/// Fits a posture to points without names. points: 3 x points [m], finite.
class PointFit {
 public:
  /// Soft assignment and a step in turns, while the spread of the markers shrinks.
  void Anneal(const Eigen::Ref<const Eigen::Matrix3Xd>& points, const Annealing& annealing,
              MovingBody* body, Posture* posture);

  /// The cost of a posture, which may be off by `spread` [m], with the cheapest assignment.
  double Assign(const Eigen::Ref<const Eigen::Matrix3Xd>& points, double spread,
                const Posture& posture, MovingBody* body);

  /// Assignment and a step in turns, as long as that is clearly cheaper. The last turn may be a
  /// little dearer than the one before; then `keeps_cheapest` takes it back. The cost.
  struct Turns {
    double spread;  ///< [m] that the posture may be off
    int most;
    bool keeps_cheapest;
  };
  double Settle(const Eigen::Ref<const Eigen::Matrix3Xd>& points, const Turns& turns,
                MovingBody* body, Posture* posture);

  /// Of the last Assign or Settle: the point of each marker, -1: none.
  const std::vector<int>& point_of_marker() const { return point_of_marker_; }
  /// Of the last assignment that was tried, markers x points.
  const Eigen::MatrixXd& costs() const { return costs_; }

 private:
  SoftAssignment soft_;
  LinearAssignment assignment_;
  Eigen::MatrixXd costs_;
  std::vector<int> point_of_marker_, points_before_;
  Posture before_;
  Eigen::Matrix3Xd targets_;
  Eigen::VectorXd noise_;
};

}  // namespace mmm_converter
