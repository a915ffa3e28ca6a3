// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "common/fit/posture_fit.h"

namespace mmm_converter {

/// Finds a posture from nothing: a rigid fit gives the root, Levenberg-Marquardt the joints, and
/// random restarts of single limbs leave wrong local minima. Seeded; no allocation after
/// construction.
class PostureSearch {
 public:
  /// kinematics must outlive the search.
  explicit PostureSearch(const MarkerKinematics& kinematics);

  /// Starts over. z: 3 x markers [m], NaN = not seen, at least three seen.
  /// attempts: random restarts after the first fit. Joints that turn freely end within half a
  /// turn of their rest.
  PostureFit::Result Assemble(const Eigen::Ref<const Eigen::Matrix3Xd>& z,
                              const Eigen::VectorXd& noise_scale, const PostureFitOptions& options,
                              int attempts, Posture* posture);

  /// One attempt to do better than `posture`: joints that move one badly fitting marker are
  /// thrown anew, from one of them on to the limb's end; every fourth time all others start from
  /// the rigid fit. True, and posture replaced, where the cost is lower by more than a hundredth.
  bool Improve(const Eigen::Ref<const Eigen::Matrix3Xd>& z, const Eigen::VectorXd& noise_scale,
               const PostureFitOptions& options, Posture* posture);

  /// One from joint angles, those of another frame, say: the root by the rigid fit. True, and
  /// posture replaced, as Improve.
  bool ImproveFrom(const Eigen::VectorXd& joint_angles, const Eigen::Ref<const Eigen::Matrix3Xd>& z,
                   const Eigen::VectorXd& noise_scale, const PostureFitOptions& options,
                   Posture* posture);

  PostureFit& fit() { return fit_; }

  /// The only thing that a call leaves behind for the next one.
  std::mt19937& random() { return random_; }

 private:
  /// Of a root that floats: the pose that brings the model's markers at `posture->joint_angles`
  /// nearest to z (Kabsch 1976). Markers count less the more joints lie between them and the root.
  void FitRigid(const Eigen::Ref<const Eigen::Matrix3Xd>& z, Posture* posture);

  /// Joints that turn freely, by whole turns, to within half a turn of the angles of `reference`.
  void Unwind(const Eigen::VectorXd& reference, Posture* posture) const;

  /// Of trial_, from where it is.
  bool TakeIfBetter(const Eigen::Ref<const Eigen::Matrix3Xd>& z, const Eigen::VectorXd& noise_scale,
                    const PostureFitOptions& options, Posture* posture);

  void RandomizeLimb(const Eigen::Ref<const Eigen::Matrix3Xd>& z, Posture* posture);

  const MarkerKinematics& kinematics_;
  PostureFit fit_;
  MarkerJacobian at_;
  Eigen::VectorXd rigidity_;           // per marker
  Eigen::VectorXd squared_distances_;  // [m^2] of each marker from its measurement
  Posture trial_;
  std::mt19937 random_;
};

}  // namespace mmm_converter
