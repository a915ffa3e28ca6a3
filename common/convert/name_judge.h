// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "common/convert/named_markers.h"
#include "common/model/posture.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter {

/// A label on the way to its meaning.
struct Hypothesis {
  int label = 0;  ///< of the named markers and of the recording
  /// The markers of its readings in the judge's model; -1: the model has none. A cluster has five
  /// for each (its place, origin and axes of its segment).
  std::vector<int> markers;
  std::size_t chosen = 0;  ///< of the readings
  bool is_out = false;
};

constexpr std::size_t kClusterMarkers = 5;

/// The first marker of the reading that was chosen for a cluster.
inline std::size_t FirstMarkerOf(const Hypothesis& one) { return kClusterMarkers * one.chosen; }

/// Postures of some frames of a recording, fitted to what the labels' names mean, and what they say
/// of the names; see UnderstandLabels.
class NameJudge {
 public:
  /// All must outlive it; named is changed by Compose only as far as others see.
  NameJudge(const KinematicModel& reference, const std::vector<int>& joints,
            const MarkerSequence& recording, const LandmarkTable& table, NamedMarkers* named);

  bool has_frames() const { return !frames_.empty(); }
  void Run(bool places_clusters);
  /// How far labels are from their places, on average, those far away counting as 0.3 m [m].
  double MeanDistance() const;
  /// What was found, as a marker set anew.
  void Compose();

 private:
  static std::size_t Ix(int i) { return static_cast<std::size_t>(i); }
  const Landmark& LandmarkOf(const LabelReading& reading) const {
    return table_.landmarks()[Ix(reading.landmark)];
  }
  bool IsPlace(const LabelReading& reading) const {
    return LandmarkOf(reading).kind != LandmarkKind::kSegment;
  }
  const LabelReading& Chosen(const Hypothesis& one) const {
    return named_.labels[Ix(one.label)].readings[one.chosen];
  }
  double DeviationOf(const Hypothesis& one) const { return LandmarkOf(Chosen(one)).deviation; }

  /// What is named left may be worn right.
  void AddMirroredReadings();
  /// Makes a marker for each reading, and for clusters four more that show how the segment lies.
  void MakeModel();
  void ChooseFrames();

  std::vector<MarkerIx> ChosenMarkers() const;
  Eigen::VectorXd NoiseScales() const;
  double FindHeight() const;
  /// The frame as the fit sees it: what is left out is not seen.
  Eigen::Matrix3Xd Measured(int frame) const;
  /// The postures of the frames at a height, and where they have all markers of the model.
  /// clusters: weigh as little as their places are known; they tell how a thigh lies whose knee has
  /// no marker.
  void Pose(double height, const std::vector<Hypothesis>& clusters);
  /// The median distance of a label from a marker of the model; NaN where it is not seen.
  double Distance(int label, int marker) const;

  /// limbs: "all", "arms" or "legs".
  bool IsOf(const Hypothesis& one, std::string_view limbs) const;
  /// Whether a label is so far from its place that it may mean something else.
  bool IsAnyFar() const;
  /// Gives all labels, those of the arms or those of the legs the other side, and keeps that if it
  /// is clearly nearer. Clusters, which are placed by the postures, would hide that later.
  void ExchangeSides(double height);
  /// The reading that mirrors the one that is chosen; the same where there is none.
  std::size_t MirroredReading(const Hypothesis& one) const;

  /// Gives each of two labels of a part of the body the other's place, on one side or on both, and
  /// keeps what takes most of their distances away: MT1 and MT5, the front and the back of a head
  /// or of a pelvis, the heels.
  void ExchangePairs(double height);
  /// Labels of places that are exchanged together.
  using ExchangedPair = std::vector<std::pair<std::size_t, std::size_t>>;
  std::vector<ExchangedPair> DoubtfulPairs() const;
  /// By how much nearer two places are to each other's in the postures of their own [m]; NaN where
  /// they are not exchanged.
  double GainOf(std::size_t i, std::size_t j) const;
  /// Returns what it gains, all labels together [m]; 0: it is wrong.
  double TryExchange(const ExchangedPair& pairs, double height);
  void Exchange(const ExchangedPair& pairs);
  void ExchangeReadings(Hypothesis* one, Hypothesis* other, std::size_t markers_of_one);
  void TellExchange(const Hypothesis& a, const Hypothesis& b);
  double SumOfDistances(const ExchangedPair& pairs) const;

  /// Clusters whose names can mean several segments are on the one that is nearest.
  void ChooseSegments();
  /// Gives the farther half of the labels that are far from their places other meanings or none.
  bool Reconsider();
  bool Reconsider(Hypothesis* one);
  /// Whether the name itself can mean several places.
  bool HasChoice(const Hypothesis& one) const;

  /// Where a cluster is on a segment, by the postures [m].
  struct ClusterPlace {
    Eigen::Vector3d p_SM;  ///< of 1 m
    double stray = 0;      ///< of its label about it, the median
    double away = 0;       ///< from where such are usually worn
    bool IsWorn() const;
  };
  /// marker: the first of the cluster's reading. Nothing where no frame shows it.
  std::optional<ClusterPlace> FindPlace(int label, int marker, double height) const;
  /// Two clusters neither of which can be worn as it says, and both as the other says.
  void ExchangeClusters(double height);
  void PlaceClusters(double height);
  void PlaceCluster(const Hypothesis& one, const ClusterPlace& place);
  void TakePlace(const NamedLabel& before, const NamedLabel& now, MarkerSet* set) const;

  const KinematicModel& reference_;
  const std::vector<int>& joints_;
  const MarkerSequence& recording_;
  const LandmarkTable& table_;
  NamedMarkers& named_;
  std::optional<KinematicModel> model_;  ///< of 1 m, with a marker for each reading
  std::vector<Hypothesis> places_, clusters_;
  std::vector<bool> is_placed_;  ///< by label: a cluster's, by the postures
  std::vector<int> frames_;
  std::vector<Posture> postures_;
  std::vector<Eigen::Matrix3Xd> p_WM_;  ///< by frame, all markers of the model
};

}  // namespace mmm_converter
