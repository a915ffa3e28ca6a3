// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/calibrate/body_kinematics.h"
#include "common/fit/normal_equations.h"
#include "common/math/padded_matrix.h"
#include "common/model/posture.h"

namespace mmm_converter {

/// The normal equations of what all frames share: [offset of each used marker 3 [m]; scales].
struct BodyEquations {
  explicit BodyEquations(const BodyKinematics& kinematics);
  void SetZero();
  void Add(const BodyEquations& other);
  int size() const { return H.rows(); }

  PaddedMatrix H;     ///< lower triangle
  Eigen::VectorXd g;  ///< minus the gradient
};

/// One frame of the joint fit: the equations of its posture about the latest one, with the part
/// that couples it to the body. Steps are [root position (W) 3 [m]; root rotation (body) 3 [rad];
/// tracked joints [rad]]. Made once; nothing is allocated later.
class FrameEquations {
 public:
  /// z: 3 x used markers [m], NaN: not seen. deviation: of each marker's coordinates [m]. share: of
  /// what the frame says that no other one says too, (0, 1].
  FrameEquations(const BodyKinematics& kinematics, Eigen::Matrix3Xd z, Eigen::VectorXd deviation,
                 double share);

  /// Draws the posture to one that is known. information: about its [rotation (body) 3; joint
  /// angles] [1/rad^2]; empty: draws no longer.
  void DrawTo(const Posture& known, Eigen::VectorXd information);

  /// `share` of -log of the likelihood of z at a posture, and of the posture, where marker
  /// distances are distributed as in FitBody. Keeps what Linearize needs.
  double Cost(const BodyKinematics& kinematics, const Posture& posture);

  /// About the posture that Cost got last; adds to `body` what the frame says of it.
  void Linearize(const BodyKinematics& kinematics, const Posture& posture, BodyEquations* body);

  /// Eliminates the posture: subtracts from `body` what it explains, with the diagonal of its own
  /// equations times 1 + damping. Joints that press on a limit stay.
  void Eliminate(double damping, BodyEquations* body);

  /// After Eliminate without damping: how the posture follows a change of the body, posture x body.
  Eigen::MatrixXd Slopes() const;

  /// The posture's step after Eliminate, for a step of the body. Where that would take joints over
  /// their limits, the best step that ends on these. solver: scratch for that.
  const Eigen::VectorXd& Step(const Eigen::VectorXd& body_step, const Posture& posture,
                              double damping, NormalEquations* solver);

 private:
  BodyJacobian at_;
  Eigen::Matrix3Xd z_;
  Eigen::VectorXd deviation_;
  double share_;
  Eigen::VectorXd weights_;  // of each marker in the squares, 0 where not seen
  Eigen::VectorXd natural_;  // of the tracked joints [rad]
  Posture known_;
  Eigen::VectorXd information_;  // about it
  Eigen::VectorXd lower_;
  Eigen::VectorXd upper_;
  PaddedMatrix H_;
  PaddedMatrix W_;  // body x posture
  Eigen::VectorXd g_;
  std::vector<char> held_;  // by joint
  PaddedMatrix factor_;
  PaddedMatrix eliminated_;  // W G^-T
  PaddedMatrix solved_;      // G^-1 g, then the step
  Eigen::VectorXd step_;
};

}  // namespace mmm_converter
