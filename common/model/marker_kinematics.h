// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <utility>
#include <vector>

#include "common/math/instruction_set.h"
#include "common/math/padded_matrix.h"
#include "common/model/kinematic_model.h"
#include "common/model/marker_kernels.h"
#include "common/model/posture.h"

namespace mmm_converter {

/// Marker positions of many postures at once, in structure-of-arrays form: each column holds one
/// quantity of all samples. Sized once by MarkerKinematics::MakeBatch.
struct MarkerBatch {
  PaddedMatrix rotation;  ///< in: rows of R_WS of the root, samples x 9 (R00 R01 R02 R10 ...)
  PaddedMatrix position;  ///< in: root origin in W [m], samples x 3
  PaddedMatrix angles;    ///< in: tracked joint angles [rad], samples x joints
  PaddedMatrix markers;   ///< out: p_WM [m], samples x (3 * markers), marker-major x y z
  PaddedMatrix frames;    // scratch: frames of links for one group of samples
};

/// One posture with its derivative. Sized once by MarkerKinematics::MakeJacobian.
struct MarkerJacobian {
  Eigen::Matrix3Xd p_WM;  ///< out [m], 3 x markers
  /// out: transposed d p_WM / d [root position (W) 3; root rotation (body) 3; tracked joints], dofs
  /// x (3 markers). Entries of joints that do not move a marker are 0.
  PaddedMatrix J_transposed;
  std::vector<Eigen::Matrix3d> R_WL;  ///< out: orientation of each link
  std::vector<Eigen::Vector3d> p_WL;  // scratch
};

/// What a tracker needs of a model: tracked joints, used markers, and the rigid links between them.
/// All other joints stay at 0 and are folded into the links. Immutable; may be shared by threads.
class MarkerKinematics {
 public:
  /// joints, markers: indices of the model, in the order that all results use.
  MarkerKinematics(const KinematicModel& model, std::vector<int> joints,
                   std::vector<MarkerIx> markers);

  /// The same with each marker moved by its column, in axes of its link (MarkerJacobian::R_WL),
  /// [m].
  MarkerKinematics WithMarkersMoved(const Eigen::Matrix3Xd& offsets) const;

  int num_joints() const { return static_cast<int>(joints_.size()); }
  int num_dofs() const { return 6 + num_joints(); }
  int num_markers() const { return static_cast<int>(markers_.size()); }
  const std::vector<int>& joints() const { return joints_; }
  const std::vector<MarkerIx>& markers() const { return markers_; }
  const Eigen::VectorXd& lower() const { return lower_; }  ///< [rad], tracked joints
  const Eigen::VectorXd& upper() const { return upper_; }  ///< [rad], tracked joints
  /// Of a tracked joint: turns as far as it likes.
  bool IsEndless(int joint) const { return std::isinf(upper_[joint]); }
  /// Of a tracked joint, all angles that differ [rad]: between its limits, or one turn about zero.
  std::pair<double, double> Range(int joint) const {
    if (IsEndless(joint)) return {-EIGEN_PI, EIGEN_PI};
    return {lower_[joint], upper_[joint]};
  }

  MarkerBatch MakeBatch(int num_samples) const;
  MarkerJacobian MakeJacobian() const;

  /// Fills batch->markers. Padding samples are computed from whatever stands there.
  void ComputeBatch(MarkerBatch* batch, InstructionSet set = ActiveInstructionSet()) const;

  /// Marker positions only. angles: tracked joints [rad].
  void ComputeMarkers(const Eigen::Vector3d& position, const Eigen::Matrix3d& R_WS,
                      const Eigen::Ref<const Eigen::VectorXd>& angles,
                      MarkerJacobian* result) const;

  /// Jacobian at the posture whose markers ComputeMarkers put into `result` last.
  void ComputeJacobian(MarkerJacobian* result) const;

  /// True where the tracked joint moves the marker.
  bool Moves(int joint, int marker) const { return moves_(joint, marker); }
  /// The rigid link that carries the marker: the index of MarkerJacobian::R_WL.
  int link_of_marker(int marker) const { return link_of_marker_[marker]; }

 private:
  std::vector<int> joints_;
  std::vector<MarkerIx> markers_;
  std::vector<TrackedLink> links_;  // the root first, then one for each joint, in tree order
  std::vector<MarkerSite> sites_;   // by link
  std::vector<int> link_of_marker_;
  Eigen::VectorXd lower_;
  Eigen::VectorXd upper_;
  Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic> moves_;
};

}  // namespace mmm_converter
