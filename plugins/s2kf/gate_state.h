// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

namespace mmm_converter::s2kf {

/// What MarkerGate carries from one frame to the next: where the person wears each marker beside
/// its place on the model, and which labels are wrong. By marker; offsets in the marker's link [m].
struct GateState {
  Eigen::Matrix3Xd offset;   ///< b, estimated from the residuals r of the tracked postures
  Eigen::VectorXd variance;  ///< of each coordinate of b [m^2]
  Eigen::VectorXd residual;  ///< standard deviation of each coordinate of r - b [m]
  std::vector<bool> is_calibrated;
  Eigen::Matrix3Xd usual;   ///< slow mean of r
  Eigen::VectorXi learned;  ///< frames in it
  Eigen::VectorXi
      verdicts;            ///< -1: as labelled, its own index: left out, another's: bears its label
  Eigen::VectorXi agreed;  ///< frames in a row in which a marker left out passed
  Eigen::VectorXd left_out_for;  ///< how long by now [s]
  std::vector<bool> is_hidden;
  int frames_since_change = 0;  ///< of the markers in use
  double usual_gain = 0;        ///< of `usual` in this frame

  /// A new track. skin_deviation: of each coordinate of a marker about its place on the person [m],
  /// NaN where that was not measured.
  void Start(const Eigen::VectorXd& skin_deviation);
  /// All labels right, offsets unknown.
  void Reset();
  /// The posture was assembled again: the offsets of the markers in use may be others.
  void Loosen();
  /// Takes all markers that are left out back in, wherever they are; their offsets are unknown.
  void Open();
  /// A frame begins, dt [s] after the last.
  void Advance(double dt);

  bool IsLeftOut(int m) const { return verdicts[m] == m; }
  bool IsAnyWrong() const { return (verdicts.array() >= 0).any(); }
  /// Of those seen. measured: by label, 3 x markers [m], NaN = not seen.
  int CountLeftOut(const Eigen::Matrix3Xd& measured) const;
  /// relabelled: `measured` by marker, swapped ones exchanged. z: what to track of it. NaN = not
  /// seen or, in z, left out.
  void Select(const Eigen::Matrix3Xd& measured, Eigen::Matrix3Xd* relabelled,
              Eigen::Matrix3Xd* z) const;

  /// Variance of each coordinate of r - b of a right marker [m^2].
  double VarianceOfResidual(int m) const;
  /// The person's marker was calibrated, and it was not left out for so long that it may have been
  /// attached anew: it comes back to its usual place only.
  bool IsPlaceKnown(int m) const;
  /// r is far from its usual value, where that is known. from_usual: r - usual, in any frame.
  /// place_variance: of each coordinate of the place that the posture gives the marker [m^2].
  bool IsFarOff(const Eigen::Vector3d& from_usual, int m, double place_variance = 0) const;
  /// Follows b and `usual` by the residual of a marker that is used.
  void Learn(int m, const Eigen::Vector3d& r);
};

}  // namespace mmm_converter::s2kf
