// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/fit/normal_equations.h"
#include "common/label/search/label_body.h"
#include "common/label/search/limb_search.h"
#include "common/label/search/linear_assignment.h"
#include "common/label/search/soft_assignment.h"
#include "common/math/seeded_random.h"
#include "common/model/posture.h"

namespace mmm_converter {

/// How limbs that do not match are thrown anew.
enum class LimbThrows {
  kAlone,         ///< the rest of the body stays, with its points (LimbSearch): fast
  kWithWholeBody  ///< all of the body is drawn to all points again: where it is hardly known where
                  ///< markers are worn, the rest may have points of the limb
};

/// Finds the body among points without names, in one frame and from nothing: many postures in many
/// turns, the best of them drawn to the points by soft assignment, limbs that do not match thrown
/// anew. Seeded; points: 3 x points [m], finite.
class BodySearch {
 public:
  /// body must outlive the search.
  explicit BodySearch(const LabelBody& body, LimbThrows throws = LimbThrows::kAlone);

  BodyMatch Find(const Eigen::Ref<const Eigen::Matrix3Xd>& points);

  /// Starts at a posture that is about as far off as `spread` [m] says.
  BodyMatch FindNear(const Eigen::Ref<const Eigen::Matrix3Xd>& points, const Posture& posture,
                     double spread);

  /// From a posture that is about right; the cost is that of the markers' places alone, as if the
  /// posture was not off any more: small differences count.
  BodyMatch SettleFinely(const Eigen::Ref<const Eigen::Matrix3Xd>& points, const Posture& posture);

  /// Throws badly matching limbs anew, so often, and keeps what is cheaper.
  void ImproveLimbs(const Eigen::Ref<const Eigen::Matrix3Xd>& points, int attempts,
                    BodyMatch* match);

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

  std::vector<Candidate> Candidates(const Eigen::Ref<const Eigen::Matrix3Xd>& points);
  static void Sort(std::vector<Candidate>* candidates);
  /// Draws all to the points, of which fewer and fewer go on; the cheapest is the first.
  void DrawAll(const Eigen::Ref<const Eigen::Matrix3Xd>& points,
               std::vector<Candidate>* candidates);
  /// Steps of soft assignment, while the spread goes from one value to the other.
  void Draw(const Eigen::Ref<const Eigen::Matrix3Xd>& points, double from, double to, int steps,
            Posture* posture);
  void Step(const Eigen::MatrixXd& targets, const Eigen::VectorXd& noise, Posture* posture);
  double SoftCost(const Eigen::Ref<const Eigen::Matrix3Xd>& points, const Posture& posture,
                  double spread);
  /// Assignment and fit in turns.
  BodyMatch Settle(const Eigen::Ref<const Eigen::Matrix3Xd>& points, const Posture& posture,
                   double settled = MatchCosts::kSettled);

  void ImproveWithWholeBody(const Eigen::Ref<const Eigen::Matrix3Xd>& points, int attempts,
                            BodyMatch* match);
  /// False: the marker that was drawn moves with the root.
  bool ThrowLimb(const BodyMatch& match, Posture* posture);

  const LabelBody& body_;
  LimbThrows throws_;
  NormalEquations equations_;
  SoftAssignment soft_;
  LinearAssignment assignment_;
  LimbSearch limbs_;
  SeededRandom random_;
  Eigen::VectorXd variances_, noise_;
  Eigen::MatrixXd cost_;  // markers x points
  Eigen::Matrix3Xd targets_;
};

}  // namespace mmm_converter
