// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/model/marker_kinematics.h"

namespace mmm_converter::s2kf {

class MarkerFilter;

/// Tells markers that can't be where they are said to be: swapped labels, ghosts, jumps.
///
/// A person wears every marker some centimetres beside its place on the model, nearly constant in
/// the frame of its link. The gate follows this offset b of each marker (a random walk, estimated
/// by a Kalman filter from the residuals r of the tracked postures) and asks whether r - b is what
/// b's variance, the residuals' own and that of the expected position allow (chi-square, 3 degrees
/// of freedom); and whether r is far from its usual value of the last seconds. Markers that fail
/// are left out; two that explain each other's places are taken as swapped. Nothing is allocated
/// after construction.
class MarkerGate {
 public:
  /// All that the gate carries from one frame to the next.
  struct State {
    Eigen::Matrix3Xd offset;   ///< b, in the marker's link [m]
    Eigen::VectorXd variance;  ///< of each coordinate of b [m^2]
    Eigen::Matrix3Xd usual;    ///< slow mean of r, in the marker's link [m]
    Eigen::VectorXi learned;   ///< frames in it
    Eigen::VectorXi verdicts;  ///< see MarkerGate::verdicts
    Eigen::VectorXi agreed;    ///< frames in a row in which a marker left out passed
    std::vector<bool> is_hidden;
    int frames_since_change = 0;  ///< of the markers in use
  };

  /// probability: of a right marker to fail in a frame; 0: none fails. kinematics must outlive the
  /// gate.
  MarkerGate(const MarkerKinematics& kinematics, double probability);

  /// All labels right, offsets unknown.
  void Reset();
  /// The track was taken up anew: the offsets of the markers in use may be others.
  void Loosen();

  /// Takes all markers that are left out back in, wherever they are.
  void Open();

  int CountLeftOut(const Eigen::Matrix3Xd& measured) const;

  /// A frame begins, dt [s] after the last.
  void Advance(double dt);

  /// z: what to track, 3 x markers [m], of `measured`, which is by label. NaN = not seen or left
  /// out.
  void Select(const Eigen::Matrix3Xd& measured, Eigen::Matrix3Xd* z) const;

  /// True where a marker of z is too far from its place beside the estimate's markers.
  bool IsSuspicious(const Eigen::Matrix3Xd& z, const MarkerJacobian& at) const;

  /// Takes those of z for swapped that are far from where `prior`, the estimate before the frame,
  /// has them, and explain each other. True where there are such.
  bool ExchangeByPrior(const Eigen::Matrix3Xd& measured, const MarkerJacobian& prior);

  /// Expects the markers where an estimate from z without the offsets has them, plus the offsets:
  /// that does not move when some are left out, as the filter's own estimate does.
  void Expect(const Eigen::Matrix3Xd& z, const MarkerJacobian& at, MarkerFilter* filter);

  /// Leaves out the worst of those markers of z that are too far from where they are expected.
  /// False: there is none.
  bool LeaveOutWorst(const Eigen::Matrix3Xd& z);

  /// Judges the markers that are left out, by what is expected without them. True where that
  /// changed something, so that the frame is to be estimated again.
  bool Settle(const Eigen::Matrix3Xd& measured, MarkerFilter* filter);

  /// Moves the offsets so that markers stay where they are expected, beside the estimate's.
  void MoveOffsets(const MarkerJacobian& at);

  /// The frame's estimate stands: follows the offsets.
  void Learn(const Eigen::Matrix3Xd& z, const MarkerJacobian& at);

  /// By marker: -1 as labelled, its own index: left out, another's: bears that one's label.
  const Eigen::VectorXi& verdicts() const { return now_.verdicts; }
  bool is_any_wrong() const { return (now_.verdicts.array() >= 0).any(); }

  const State& state() const { return now_; }
  void set_state(const State& state) { now_ = state; }

 private:
  /// Squared Mahalanobis distance of a deviation from the place of marker m, over what is allowed.
  double Score(const Eigen::Vector3d& deviation, int m) const;
  double Score(const Eigen::Matrix3Xd& points, int point, int m) const {
    return Score(points.col(point) - expected_.col(m), m);
  }
  bool IsFarOff(const Eigen::Vector3d& from_usual, int m) const;
  void LeaveOut(int m);
  bool Readmit(const Eigen::Matrix3Xd& measured);
  bool Exchange(const Eigen::Matrix3Xd& measured);

  const MarkerKinematics& kinematics_;
  double allowed_;  // squared Mahalanobis distance
  State now_;
  double usual_gain_ = 0;                    // of this frame
  Eigen::Matrix3Xd offset_W_;                // b in W
  Eigen::Matrix3Xd usual_W_;                 // usual r in W
  Eigen::VectorXd unoffset_;                 // z - b, stacked
  Eigen::VectorXd places_;                   // expected p, stacked
  Eigen::Matrix3Xd expected_;                // p + b
  std::vector<Eigen::Matrix3d> covariance_;  // of p [m^2]; 0 where the marker was used
  Eigen::VectorXd scores_;
};

}  // namespace mmm_converter::s2kf
