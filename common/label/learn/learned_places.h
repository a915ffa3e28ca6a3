// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "common/fit/posture_fit.h"
#include "common/label/learn/body_sites.h"
#include "common/label/learn/learn_frames.h"
#include "common/label/learn/named_places.h"

namespace mmm_converter {

/// Where a label is worn, as far as is known.
struct WornPlace {
  int site = -1;  ///< -1: not on the body
  Eigen::Vector3d p_SM = Eigen::Vector3d::Zero();
  double scatter = 0;  ///< about the place, each coordinate [m]
  double lead = 0;     ///< how much less it costs than on the next best site
};

/// Finds places and postures in turns: postures of all frames by the places that are believed, then
/// the site on which each label moves least, and its place there.
class LearnedPlaces {
 public:
  /// sites must outlive it. deviations: labels x labels, of their distances over the frames [m].
  /// named: by label, what names say.
  LearnedPlaces(const BodySites& sites, std::vector<LearnFrame> frames, Eigen::MatrixXd deviations,
                std::vector<NamedPlace> named);

  /// Starts over with the body that was found in one frame.
  void Start(int frame, const Posture& posture);
  /// Starts over with the body as it wears the labels there; those without site are not used.
  void Start(const std::vector<WornPlace>& places);
  /// Postures, then places, so often.
  /// independent: frames that count each for itself, at most.
  void Iterate(int times, double independent);

  /// Skin slides over joints: near these, how a label moves says less of its site. Costs before and
  /// after are not comparable.
  void AllowForSkinAtJoints();

  /// The same with some labels on a site, all others where they are, after so many turns.
  std::unique_ptr<LearnedPlaces> Moved(const std::vector<int>& labels, int site, int turns) const;

  /// What places and postures cost together; the same labels and frames are comparable.
  double cost() const { return cost_; }
  const std::vector<WornPlace>& places() const { return places_; }
  const std::vector<LearnFrame>& frames() const { return frames_; }
  /// By label, -1: none.
  std::vector<int> SitesOfLabels() const;
  /// labels x sites: what each label costs on each site.
  const Eigen::MatrixXd& costs() const { return costs_; }
  /// Mean distance of the labels from their places [m].
  double mean_distance() const { return mean_distance_; }

  /// The part of these that places alone say, without any motion or name.
  const Eigen::MatrixXd& prior_costs() const { return prior_costs_; }

  /// How far a place is outside of where a site has its markers [m].
  double DistanceBeyond(int site, const Eigen::Vector3d& p_SM) const;

 private:
  /// What it costs that a label keeps no distance from those of a site, labels x sites.
  Eigen::MatrixXd Strangeness() const;
  double PriorCost(int label, int site, const Eigen::Vector3d& p_SM) const;
  /// What it costs that a label is on a site although its name says another one.
  double CostOfOtherThanNamed(int label, int site) const;
  void FitPostures();
  void ChoosePlaces();
  std::unique_ptr<const MarkerKinematics> MakeKinematics(KinematicModel* model) const;

  const BodySites& sites_;
  std::vector<LearnFrame> frames_;
  std::vector<WornPlace> places_;
  std::vector<int> held_;  // by label: the only site that it may be on; -1: any
  bool is_searching_ = true;
  Eigen::MatrixXd deviations_;
  std::vector<NamedPlace> named_;
  Eigen::MatrixXd costs_, prior_costs_;
  Eigen::VectorXd skin_;   // by label, each coordinate [m]
  Eigen::VectorXd radii_;  // of sites [m]
  int start_ = 0;
  double independent_ = 1;
  double cost_ = 0, mean_distance_ = 0;
};

}  // namespace mmm_converter
