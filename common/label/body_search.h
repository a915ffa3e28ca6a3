// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/fit/normal_equations.h"
#include "common/label/label_body.h"
#include "common/label/linear_assignment.h"
#include "common/label/soft_assignment.h"
#include "common/math/seeded_random.h"
#include "common/model/posture.h"

namespace mmm_converter {

/// A posture, and which point is which marker in it.
struct BodyMatch {
  Posture posture;                   ///< tracked joints
  std::vector<int> point_of_marker;  ///< -1: none
  /// Of each marker min(d^2 / v, 9), v its place's and the posture's variance; of angles their
  /// distance from the natural ones.
  double cost = 0;
  int matched = 0;
};

/// Finds the body among points without names, in one frame and from nothing: many postures in many
/// turns, the best of them drawn to the points by soft assignment, limbs that do not match thrown
/// anew. Seeded; points: 3 x points [m], finite.
class BodySearch {
 public:
  /// body must outlive the search.
  explicit BodySearch(const LabelBody& body);

  BodyMatch Find(const Eigen::Ref<const Eigen::Matrix3Xd>& points);

  /// Starts at a posture that is about as far off as `spread` [m] says.
  BodyMatch FindNear(const Eigen::Ref<const Eigen::Matrix3Xd>& points, const Posture& posture,
                     double spread);

  /// Throws the joints of a badly matching marker anew, so often, and keeps what is cheaper.
  void ImproveLimbs(const Eigen::Ref<const Eigen::Matrix3Xd>& points, int attempts,
                    BodyMatch* match);

  /// The cheapest match at this posture.
  BodyMatch Match(const Eigen::Ref<const Eigen::Matrix3Xd>& points, const Posture& posture);

 private:
  struct Candidate {
    Posture posture;
    double cost = 0;
  };

  std::vector<Candidate> Candidates(const Eigen::Ref<const Eigen::Matrix3Xd>& points);
  /// Steps of soft assignment, while the spread goes from one value to the other.
  void Draw(const Eigen::Ref<const Eigen::Matrix3Xd>& points, double from, double to, int steps,
            Posture* posture);
  void Step(const Eigen::MatrixXd& targets, const Eigen::VectorXd& noise, Posture* posture);
  double SoftCost(const Eigen::Ref<const Eigen::Matrix3Xd>& points, const Posture& posture,
                  double spread);
  /// Assignment and fit in turns.
  BodyMatch Settle(const Eigen::Ref<const Eigen::Matrix3Xd>& points, const Posture& posture);
  /// False: the marker that was drawn moves with the root.
  bool ThrowLimb(const BodyMatch& match, Posture* posture);

  const LabelBody& body_;
  NormalEquations equations_;
  SoftAssignment soft_;
  LinearAssignment assignment_;
  SeededRandom random_;
  Eigen::VectorXd variances_, noise_;
  Eigen::MatrixXd cost_;  // markers x points
  Eigen::Matrix3Xd targets_;
};

}  // namespace mmm_converter
