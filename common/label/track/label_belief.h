// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/label/search/label_body.h"
#include "common/math/padded_matrix.h"
#include "common/model/posture.h"

namespace mmm_converter {

/// What is believed of a person between two frames: postures and velocities are normal, in tangent
/// coordinates (Retract). Velocities are correlated in time (Ornstein-Uhlenbeck); how fast each dof
/// is expected to be follows from how fast it was, so that feet that stand are foreseen to stand.
struct LabelBelief {
  Posture posture;                   ///< tracked joints
  Eigen::VectorXd velocity;          ///< of the dofs [m/s], [rad/s]
  Eigen::MatrixXd P_qq, P_qv, P_vv;  ///< covariance of dofs and velocities
  Eigen::VectorXd speed;             ///< of the dofs from now on, standard deviation [m/s], [rad/s]
  Eigen::Matrix3Xd offset;  ///< of the markers from the model's places, axes of their links [m]
  Eigen::VectorXd offset_variance;  ///< of each coordinate [m^2]

  Posture PostureAfter(const LabelBody& body, double dt) const;
  /// dt [s] later.
  void Predict(const LabelBody& body, double dt);
  /// By what a frame made of the predicted posture, whose inverse covariance is `prior`.
  struct Scratch {
    explicit Scratch(int dofs) : gain(dofs, dofs), factor(dofs, dofs), product(dofs, dofs) {}
    PaddedMatrix gain, factor, product;
  };
  void Correct(const Eigen::MatrixXd& prior, const Posture& corrected, const Eigen::MatrixXd& P,
               Scratch* scratch);
  /// What hardly moved of late will hardly move; a dof of which no marker has a point can do
  /// anything. dt [s]: since the last frame.
  void ExpectSpeeds(const LabelBody& body, const std::vector<int>& point_of_marker, double dt);
  /// Time runs the other way from now on.
  void Reverse() {
    velocity *= -1;
    P_qv *= -1;
  }
};

/// Of a body that was found there, its markers at places that are not known better than the model
/// has them.
LabelBelief BeliefAt(const LabelBody& body, const Posture& posture);

}  // namespace mmm_converter
