// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/fit/normal_equations.h"
#include "common/model/marker_kinematics.h"
#include "common/model/posture.h"

namespace mmm_converter {

/// The rest of every tracked joint (0), clamped into its limits: where a joint is that no marker
/// determines.
Eigen::VectorXd NaturalAngles(const MarkerKinematics& kinematics);

/// A joint without limits rests wherever it is: its natural angle becomes that of `angles`.
void RestEndlessJoints(const MarkerKinematics& kinematics, const Eigen::VectorXd& angles,
                       Eigen::VectorXd* natural);

/// A pull of its own of one tracked joint: adds weight sum(1 / s_m^2) (theta - value)^2 over the
/// seen markers m to the cost.
struct JointPull {
  int joint = 0;      ///< tracked
  double value = 0;   ///< [rad], sliding [m]
  double weight = 0;  ///< [m^2/rad^2], sliding [1]
};

struct PostureFitOptions {
  int max_iterations = 30;
  /// Converged where an accepted step lowers the cost by less than this share of it.
  double tolerance = 1e-4;
  /// Huber: a marker that is farther off counts with its distance only [m].
  double robust_distance = 1e9;
  /// Pull to the natural angle: 1 rad costs as much as one marker this far off [m/rad].
  double natural_weight = 0.003;
  /// Pull to the angles that the fit starts from, in the same unit.
  double start_weight = 0;
  std::vector<JointPull> pulls = {};
};

/// Levenberg-Marquardt fit of a posture to marker positions, inside the joint limits:
///   min over q   sum_m rho(|z_m - p_m(q)|^2) / s_m^2 + w^2 sum_j (theta_j - natural_j)^2
///               + v^2 sum_j (theta_j - start_j)^2,  l <= theta <= u,
/// natural_j being start_j where a joint has no limits,
/// with steps that end on a limit rather than beyond it. Postures hold the tracked
/// joints of `kinematics`. No allocation after construction.
class PostureFit {
 public:
  /// kinematics must outlive the fit.
  explicit PostureFit(const MarkerKinematics& kinematics);

  struct Result {
    double cost = 0;           ///< [m^2]
    double mean_distance = 0;  ///< over seen markers [m]
    int iterations = 0;
    bool converged = false;
  };

  /// z: 3 x markers [m], NaN = not seen. noise_scale: s_m, per marker. posture: start and result.
  Result Solve(const Eigen::Ref<const Eigen::Matrix3Xd>& z, const Eigen::VectorXd& noise_scale,
               const PostureFitOptions& options, Posture* posture);

  /// The cost and the distances at a posture that a fit would start from.
  Result Evaluate(const Eigen::Ref<const Eigen::Matrix3Xd>& z, const Eigen::VectorXd& noise_scale,
                  const PostureFitOptions& options, const Posture& posture);

  const MarkerKinematics& kinematics() const { return kinematics_; }
  /// Those of joints without limits are where the last Evaluate or Solve started.
  const Eigen::VectorXd& natural_angles() const { return natural_; }

 private:
  Result ComputeCost(const Eigen::Ref<const Eigen::Matrix3Xd>& z,
                     const Eigen::VectorXd& noise_scale, const PostureFitOptions& options,
                     const Posture& posture);
  void Linearize(const Eigen::Ref<const Eigen::Matrix3Xd>& z, const Eigen::VectorXd& noise_scale,
                 const PostureFitOptions& options, const Posture& posture);
  /// The damped step, with joints that it would take over a limit stepping onto it.
  const Eigen::VectorXd& Step(const Posture& posture, double damping);

  const MarkerKinematics& kinematics_;
  Eigen::VectorXd natural_;
  Eigen::VectorXd start_;     // joint angles
  std::vector<int> resting_;  // joints that move no marker: nothing tells where they are
  NormalEquations equations_;
  Posture trial_;
  double seen_weight_ = 0;  // of the markers seen
};

}  // namespace mmm_converter
