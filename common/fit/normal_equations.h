// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/math/padded_matrix.h"
#include "common/model/marker_kinematics.h"
#include "common/model/posture.h"

namespace mmm_converter {

/// The linear model of a fit to marker positions about a posture, and its steps inside the joint
/// limits: minimises |W (z - p - J step)|^2 over steps = [root position (W) 3; root rotation (body)
/// 3; tracked joints]. Callers may add to H and g before they solve. No allocation after
/// construction.
class NormalEquations {
 public:
  /// kinematics must outlive them.
  explicit NormalEquations(const MarkerKinematics& kinematics);

  /// Where the markers of a posture are, 3 x markers [m]; the posture is the next one to linearize.
  const Eigen::Matrix3Xd& Place(const Posture& posture);

  /// H = J^T W^2 J and g = J^T W^2 (z - p) about the posture placed last. z: 3 x markers [m], NaN =
  /// not seen. noise_scale: per marker. Markers farther than robust_distance [m] pull with it only
  /// (Huber).
  void Linearize(const Eigen::Ref<const Eigen::Matrix3Xd>& z, const Eigen::VectorXd& noise_scale,
                 double robust_distance);

  PaddedMatrix::View H() { return H_.view(); }  ///< lower triangle; [1], [m/rad], [m^2/rad^2]
  Eigen::VectorXd& g() { return g_; }           ///< [m], [m^2/rad]

  /// Joints on a limit that g presses against it stay there, and no others are held.
  void HoldPressingJoints(const Eigen::VectorXd& angles);
  /// Joints that the last step takes over a limit are to step onto it; false where there are none.
  bool HoldOversteppingJoints(const Eigen::VectorXd& angles);

  /// Makes the step for H + diag(relative H_ii + absolute); the parts of held joints are given.
  void Solve(double relative, double absolute);
  const Eigen::VectorXd& step() const { return step_; }  ///< [m], [rad]

 private:
  void Hold(int joint, double step);

  const MarkerKinematics& kinematics_;
  MarkerJacobian at_;
  Eigen::VectorXd residual_;  // weighted
  PaddedMatrix H_;
  Eigen::VectorXd g_;
  std::vector<char> is_held_;  // by joint
  Eigen::VectorXd held_step_;  // by joint; 0 where not held
  PaddedMatrix damped_;
  PaddedMatrix solution_;
  Eigen::VectorXd step_;
};

}  // namespace mmm_converter
