// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/model/marker_kinematics.h"
#include "plugins/s2kf/gate_state.h"
#include "plugins/s2kf/update_outcome.h"

namespace mmm_converter::s2kf {

/// Tells markers that can't be where they are said to be: swapped labels, ghosts, jumps.
///
/// A person wears every marker some centimetres beside its place on the model, nearly constant in
/// the frame of its link. The gate follows this offset b of each marker (a random walk, estimated
/// by a Kalman filter from the residuals r of the tracked postures) and asks whether r - b is what
/// b's variance, the residuals' own and that of the expected position allow (chi-square, 3 degrees
/// of freedom); and whether r is far from its usual value of the last seconds. Markers that fail
/// are left out; two that explain each other's places are taken as swapped.
///
/// State in, state out; all that is remembered between frames is GateState. Within a frame (see
/// GatedUpdate) Expect comes before LeaveOutWorst, Settle and MoveOffsets. Nothing is allocated
/// after construction. z, measured: 3 x markers [m], NaN = not seen; measured is by label.
class MarkerGate {
 public:
  /// mirror: by marker, the one at that place of the other side; -1: none. probability: of a right
  /// marker to fail in a frame; 0: none fails. kinematics must outlive the gate.
  MarkerGate(const MarkerKinematics& kinematics, std::vector<int> mirror, double probability);

  /// True where a marker of z is too far from its place beside the estimate's markers.
  bool IsSuspicious(const GateState& state, const Eigen::Matrix3Xd& z,
                    const MarkerJacobian& at) const;

  /// Takes back exchanges whose labels explain the places better as they are, by where `prior`, the
  /// estimate before the frame, has the markers: an exchange has to be better in every frame.
  void Reconsider(const Eigen::Matrix3Xd& measured, const MarkerJacobian& prior, GateState* state);

  /// Takes those for swapped that are far from where `prior`, the estimate before the frame, has
  /// them, and nearest to each other's places or, in both, to the other side's. True where there
  /// are such.
  bool ExchangeByPrior(const Eigen::Matrix3Xd& measured, const MarkerJacobian& prior,
                       GateState* state);

  /// Expects the markers where the update that left `outcome` would have put them by z without the
  /// offsets, plus the offsets: that does not move when some are left out, as the estimate `at`
  /// does.
  void Expect(const GateState& state, const Eigen::Matrix3Xd& z, const MarkerJacobian& at,
              const UpdateOutcome& outcome);

  /// Leaves out the worst of those markers of z that are too far from where they are expected.
  /// False: there is none.
  bool LeaveOutWorst(const Eigen::Matrix3Xd& z, GateState* state);

  /// Judges the markers that are left out, by what is expected without them. True where that
  /// changed something, so that the frame is to be estimated again.
  bool Settle(const Eigen::Matrix3Xd& measured, const UpdateOutcome& outcome, GateState* state);

  /// Moves the offsets so that markers stay where they are expected, beside the estimate's.
  void MoveOffsets(const MarkerJacobian& at, GateState* state) const;

  /// The frame's estimate stands: follows the offsets.
  void Learn(const Eigen::Matrix3Xd& z, const MarkerJacobian& at, GateState* state) const;

 private:
  /// Squared Mahalanobis distance of a point from the place of marker m, over what is allowed.
  double Score(const GateState& state, const Eigen::Matrix3Xd& points, int point, int m) const;
  void ExpectByPrior(const MarkerJacobian& prior, const Eigen::Matrix3Xd& offsets);
  /// A joint moves both and not the one beyond.
  bool IsOnLimb(int other, int marker, int beyond) const;
  /// Expects a limb of which markers were exchanged where these are seen to have moved it.
  void FollowExchanged(const Eigen::Matrix3Xd& measured, const Eigen::VectorXi& verdicts);
  /// How many pairs are exchanged between the limbs of markers a and b.
  int CountOfSameLimbs(int a, int b, const Eigen::VectorXi& verdicts) const;
  /// Exchanges those beyond `least` [m], where so many pairs of the same limbs are exchanged.
  bool ExchangeBeyond(double least, int limb_pairs, const Eigen::Matrix3Xd& measured,
                      GateState* state);
  bool Readmit(const Eigen::Matrix3Xd& measured, GateState* state) const;
  bool Exchange(const Eigen::Matrix3Xd& measured, GateState* state) const;

  const MarkerKinematics& kinematics_;
  std::vector<int> mirror_;
  double allowed_;  // squared Mahalanobis distance
  GaussianUpdate::Scratch scratch_;
  // Of this frame:
  Eigen::Matrix3Xd offset_W_;                // b in W
  Eigen::Matrix3Xd usual_W_;                 // usual r in W
  Eigen::VectorXd unoffset_;                 // z - b, stacked
  Eigen::VectorXd places_;                   // expected p, stacked
  Eigen::Matrix3Xd expected_;                // p + b
  std::vector<Eigen::Matrix3d> covariance_;  // of p [m^2]; 0 where the marker was used
  Eigen::VectorXd scores_;
  std::vector<int> nearest_;  // by label: the marker expected there, where that is another
  Eigen::Matrix3Xd moved_;    // of each marker, how its limb moved
};

}  // namespace mmm_converter::s2kf
