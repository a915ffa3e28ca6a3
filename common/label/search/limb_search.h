// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "common/label/search/body_match.h"
#include "common/label/search/label_body.h"
#include "common/label/search/linear_assignment.h"
#include "common/label/search/soft_assignment.h"
#include "common/math/seeded_random.h"
#include "common/model/marker_kinematics.h"
#include "common/model/posture.h"

namespace mmm_converter {

/// Looks for single limbs, and for two that are beside each other, while the rest of the body stays
/// where it is: their joints are thrown anew and drawn to the points that the rest leaves by soft
/// assignment, or two of a link's markers are put at two points that are as far apart. Feet that
/// stand together may have each other's points: then neither is found alone.
class LimbSearch {
 public:
  /// body must outlive the search.
  explicit LimbSearch(const LabelBody& body);

  /// So many throws of limbs that match badly; keeps what is cheaper. match: of these points; the
  /// posture, points and costs of its limbs change. True: something got better.
  bool Improve(const Eigen::Ref<const Eigen::Matrix3Xd>& points, int attempts, SeededRandom* random,
               BodyMatch* match);

  /// What the markers cost more than good ones, as far as a point could be another's.
  double MostGain(const Eigen::Ref<const Eigen::Matrix3Xd>& points, const BodyMatch& match) {
    Excess(points, match);
    return excess_.sum();
  }

 private:
  /// Of each marker, what it costs more than a good one and can be spared.
  void Excess(const Eigen::Ref<const Eigen::Matrix3Xd>& points, const BodyMatch& match);
  const LabelBody::Limb* DrawLimb(SeededRandom* random) const;
  /// The one with a marker nearest to the limb's in the best match; null: none is near.
  const LabelBody::Limb* LimbBeside(const LabelBody::Limb& limb) const;
  void Throw(const LabelBody::Limb& limb, SeededRandom* random, Posture* posture) const;
  void Place(const LabelBody::Limb& limb, const Posture& posture);
  void Draw(const LabelBody::Limb& limb, Posture* posture);
  /// Only joints that move `other`, too, move the marker.
  bool IsNearerToRoot(int marker, int other) const;
  /// Puts two markers of a link at two points that are as far from each other: among ghosts, and
  /// where others are hidden, the two that are right tell more than all together. What is nearer to
  /// the root keeps the points that Settle gave it, or not. False: there are none.
  bool DrawToPair(const LabelBody::Limb& limb, SeededRandom* random, Posture* posture);
  /// Towards targets_ with the noise of noise_, about the posture placed last. usual: angles that
  /// joints tend to.
  void Step(const LabelBody::Limb& limb, const Eigen::VectorXd& usual, Posture* posture);
  /// Assignment and fit in turns; the cost of the limb.
  double Settle(const LabelBody::Limb& limb, int turns, Posture* posture);

  const LabelBody& body_;
  MarkerJacobian at_;
  SoftAssignment soft_;
  LinearAssignment assignment_;
  LabelBody::Limb pair_;      // both of two limbs
  std::vector<int> allowed_;  // points that the limb may have
  Eigen::Matrix3Xd points_;   // these
  Eigen::Matrix3Xd found_;    // all markers of the best match
  Eigen::Matrix3Xd places_;   // of the limb's markers
  Eigen::VectorXd variances_, noise_, excess_, angles_;
  Eigen::Matrix3Xd targets_;
  Eigen::MatrixXd cost_;                          // the limb's markers x allowed points
  std::vector<int> mates_;                        // of the limb's markers, those of a link
  std::vector<std::pair<int, int>> point_pairs_;  // of points_
  std::vector<int> assigned_;                     // into allowed_, by the limb's marker
  Eigen::MatrixXd H_;
  Eigen::MatrixX3d J_;
  Eigen::VectorXd g_;
};

}  // namespace mmm_converter
