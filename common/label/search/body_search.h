// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/label/search/body_match.h"
#include "common/label/search/label_body.h"
#include "common/label/search/limb_search.h"
#include "common/label/search/moving_body.h"
#include "common/label/search/point_fit.h"
#include "common/label/tuning.h"
#include "common/math/seeded_random.h"
#include "common/model/posture.h"

namespace mmm_converter {

/// How another place is found for limbs that do not match.
enum class LimbRestarts {
  kAlone,         ///< the rest of the body stays, with its points (LimbSearch): fast
  kWithWholeBody  ///< all of the body is fitted to all points again: where it is hardly known where
                  ///< markers are worn, the rest may have points of the limb
};

/// Finds the body among points without names, in one frame and from nothing: many postures in many
/// turns, the best of them annealed (PointFit), limbs that do not match tried elsewhere. Seeded;
/// points: 3 x points [m], finite.
class BodySearch {
 public:
  /// body must outlive the search.
  explicit BodySearch(const LabelBody& body, LimbRestarts restarts = LimbRestarts::kAlone);

  BodyMatch Find(const Eigen::Ref<const Eigen::Matrix3Xd>& points);

  /// Starts at a posture that is about as far off as `spread` [m] says.
  BodyMatch FindNear(const Eigen::Ref<const Eigen::Matrix3Xd>& points, const Posture& posture,
                     double spread);

  /// From a posture that is about right; the cost is that of the markers' places alone, as if the
  /// posture was not off any more: small differences count.
  BodyMatch SettleFinely(const Eigen::Ref<const Eigen::Matrix3Xd>& points, const Posture& posture);

  /// Tries badly matching limbs elsewhere, so often, and keeps what is cheaper.
  void ImproveLimbs(const Eigen::Ref<const Eigen::Matrix3Xd>& points, int tries, BodyMatch* match);

  /// No limb can make a match cheaper by more.
  double MostGain(const Eigen::Ref<const Eigen::Matrix3Xd>& points, const BodyMatch& match) {
    return limbs_.MostGain(points, match);
  }

  /// The cheapest match at this posture. settled: deviation of what it may still be off [m].
  BodyMatch Match(const Eigen::Ref<const Eigen::Matrix3Xd>& points, const Posture& posture,
                  double settled = MatchCosts::kSettled);

 private:
  struct Candidate {
    Posture posture;
    double cost = 0;
  };

  /// Every template in every turn that is nearer to the points than its neighbours.
  std::vector<Candidate> TurnedTemplates(const Eigen::Ref<const Eigen::Matrix3Xd>& points);
  static void Sort(std::vector<Candidate>* candidates);
  /// Anneals all, of which fewer and fewer go on; the cheapest is the first.
  void AnnealAll(const Eigen::Ref<const Eigen::Matrix3Xd>& points,
                 std::vector<Candidate>* candidates);
  double SoftCost(const Eigen::Ref<const Eigen::Matrix3Xd>& points, const Posture& posture,
                  double spread);
  /// Assignment and fit in turns.
  BodyMatch Settle(const Eigen::Ref<const Eigen::Matrix3Xd>& points, Posture posture,
                   double settled = MatchCosts::kSettled);
  /// With the points of the last fit.
  BodyMatch MatchOf(const Posture& posture, double cost) const;

  void ImproveWithWholeBody(const Eigen::Ref<const Eigen::Matrix3Xd>& points, int tries,
                            BodyMatch* match);
  /// Of one badly matching marker, by the costs of the last match. False: it moves with the root.
  bool RandomizeLimb(const BodyMatch& match, Posture* posture);

  const LabelBody& body_;
  LimbRestarts restarts_;
  WholeBody whole_;
  PointFit fit_;
  LimbSearch limbs_;
  SeededRandom random_;
};

}  // namespace mmm_converter
