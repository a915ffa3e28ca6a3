// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "common/label/search/body_match.h"
#include "common/label/search/label_body.h"
#include "common/label/search/moving_body.h"
#include "common/label/search/point_fit.h"
#include "common/math/seeded_random.h"
#include "common/model/marker_kinematics.h"
#include "common/model/posture.h"

namespace mmm_converter {

/// Random angles for the joints of a limb: for all of them or for the second half. may_stay_near:
/// in some tries near the angles that they have.
void RandomizeJoints(const MarkerKinematics& kinematics, const std::vector<int>& joints,
                     bool may_stay_near, SeededRandom* random, Posture* posture);

/// Looks for single limbs, and for two that are beside each other, while the rest of the body stays
/// where it is: their joints get random angles and are fitted to the points that the rest leaves,
/// or two of a link's markers are put at two points that are as far apart. Feet that stand together
/// may have each other's points: then neither is found alone.
class LimbSearch {
 public:
  /// body must outlive the search.
  explicit LimbSearch(const LabelBody& body);

  /// So many tries with limbs that match badly; keeps what is cheaper. match: of these points; the
  /// posture, points and costs of its limbs change. True: something got better.
  bool Improve(const Eigen::Ref<const Eigen::Matrix3Xd>& points, int tries, SeededRandom* random,
               BodyMatch* match);

  /// What the markers cost more than good ones, as far as a point could be another's.
  double MostGain(const Eigen::Ref<const Eigen::Matrix3Xd>& points, const BodyMatch& match) {
    ComputeExcess(points, match);
    return excess_.sum();
  }

 private:
  /// Of each marker, what it costs more than a good one and can be spared.
  void ComputeExcess(const Eigen::Ref<const Eigen::Matrix3Xd>& points, const BodyMatch& match);
  const LabelBody::Limb* ChooseLimb(SeededRandom* random) const;
  /// The one with a marker nearest to the limb's in the best match; null: none is near.
  const LabelBody::Limb* LimbBeside(const LabelBody::Limb& limb) const;
  /// The points that the rest of the body leaves to a limb.
  void LeavePoints(const Eigen::Ref<const Eigen::Matrix3Xd>& points, const BodyMatch& match,
                   const LabelBody::Limb& limb);
  /// Only joints that move `other`, too, move the marker.
  bool IsNearerToRoot(int marker, int other) const;
  /// Puts two markers of a link at two points that are as far from each other: among ghosts, and
  /// where others are hidden, the two that are right tell more than all together. What is nearer to
  /// the root keeps the points that it had, or not. False: there are none.
  bool PutOnTwoPoints(const LabelBody::Limb& limb, SeededRandom* random, Posture* posture);
  /// Assignment and fit in turns; the cost of the limb.
  double Settle(int most_turns, Posture* posture);

  const LabelBody& body_;
  MarkerJacobian at_;
  MovingLimb moving_;
  PointFit fit_;
  Eigen::VectorXd excess_;
  Eigen::Matrix3Xd found_;   // places of the markers in the best match
  LabelBody::Limb pair_;     // two limbs as one
  std::vector<int> left_;    // of the points
  Eigen::Matrix3Xd points_;  // these
  Eigen::Matrix3Xd targets_;
  Eigen::VectorXd noise_, angles_;
  std::vector<int> mates_;                        // markers of the same link
  std::vector<std::pair<int, int>> point_pairs_;  // that are as far apart
};

}  // namespace mmm_converter
