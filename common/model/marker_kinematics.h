// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <memory>
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
  /// in: tracked joint angles [rad], sliding [m], samples x joints; behind these the values of
  /// functions of them, which are scratch
  PaddedMatrix angles;
  PaddedMatrix markers;  ///< out: p_WM [m], samples x (3 * markers), marker-major x y z
  PaddedMatrix frames;   // scratch: frames of links for one group of samples
};

/// One posture with its derivative. Sized once by MarkerKinematics::MakeJacobian.
struct MarkerJacobian {
  Eigen::Matrix3Xd p_WM;  ///< out [m], 3 x markers
  /// out: transposed d p_WM / d [root position (W) 3; root rotation (body) 3; tracked joints], dofs
  /// x (3 markers). Entries of joints that do not move a marker are 0.
  PaddedMatrix J_transposed;
  std::vector<Eigen::Matrix3d> R_WL;  ///< out: orientation of each link
  std::vector<Eigen::Vector3d> p_WL;  ///< out: where each link begins [m]
  Eigen::VectorXd values;             // scratch: angles, then functions of them
  Eigen::VectorXd slopes;             // scratch: derivatives of these by their angle
};

/// What a tracker needs of a model: tracked joints, used markers, and the rigid links between them.
/// All other joints stay at rest and are folded into the links, and so are sums and linear
/// functions: only joints that move by other functions of an angle cost more than one that turns by
/// it. Immutable; may be shared by threads.
class MarkerKinematics {
 public:
  /// joints, markers: indices of the model, in the order that all results use.
  /// Joints that the markers do not tell (UntoldJoints) rest, whatever their angles.
  MarkerKinematics(const KinematicModel& model, std::vector<int> joints,
                   const std::vector<MarkerIx>& markers);

  /// The same where other joints rest; none: postures were found by other markers, too.
  MarkerKinematics(const KinematicModel& model, std::vector<int> joints,
                   std::vector<MarkerIx> markers, const std::vector<int>& resting);

  /// The same with each marker moved by its column, in axes of its link (MarkerJacobian::R_WL),
  /// [m].
  MarkerKinematics WithMarkersMoved(const Eigen::Matrix3Xd& offsets) const;

  int num_joints() const { return static_cast<int>(joints_.size()); }
  int num_dofs() const { return 6 + num_joints(); }
  int num_markers() const { return static_cast<int>(markers_.size()); }
  const std::vector<int>& joints() const { return joints_; }
  const std::vector<MarkerIx>& markers() const { return markers_; }
  const Eigen::VectorXd& lower() const { return lower_; }  ///< [rad], sliding [m], tracked joints
  const Eigen::VectorXd& upper() const { return upper_; }  ///< [rad], sliding [m], tracked joints
  /// Where nothing moves the tracked joints [rad], sliding [m]; may be outside of the limits.
  const Eigen::VectorXd& rest() const { return rest_; }
  /// Of a tracked joint: turns as far as it likes.
  bool IsEndless(int joint) const { return std::isinf(upper_[joint]) && reach_[joint] == 0; }
  /// Of a tracked joint: has no limits, and a full turn of its angle changes nothing.
  bool TurnsFreely(int joint) const { return turns_freely_[joint]; }
  /// Of a tracked joint, all angles that differ [rad]: between its limits, or one turn about zero;
  /// of one that has a reach instead, those that it usually takes.
  std::pair<double, double> Range(int joint) const {
    if (IsEndless(joint)) return {-EIGEN_PI, EIGEN_PI};
    if (std::isinf(upper_[joint])) {
      return {rest_[joint] - reach_[joint], rest_[joint] + reach_[joint]};
    }
    return {lower_[joint], upper_[joint]};
  }
  /// The root's pose is not tracked: no marker says anything of it.
  bool is_root_fixed() const { return is_root_fixed_; }
  /// That pose, or the identity.
  const Eigen::Isometry3d& X_WS() const { return X_WS_; }

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

  /// True where the tracked joint moves the marker, through one joint or several.
  bool Moves(int joint, int marker) const { return moves_(joint, marker); }
  /// Tracked joints that move no marker, but for endless ones.
  std::vector<int> RestingJoints() const;
  /// The rigid link that carries the marker: the index of MarkerJacobian::R_WL.
  int link_of_marker(int marker) const { return link_of_marker_[marker]; }
  int num_links() const { return static_cast<int>(links_.size()); }
  const TrackedLink& link(int l) const { return links_[l]; }
  /// A segment of the model that is a part of the link; of OpenSim, its body.
  int segment_of_link(int l) const { return segment_of_link_[l]; }

 private:
  /// A column of values that is no angle.
  struct Function {
    int joint = 0;
    std::shared_ptr<const ScalarFunction> function;
  };

  TrackedLink MakeLink(const Segment& segment, int column, const Eigen::Isometry3d& X_LF,
                       Eigen::Isometry3d* X_LS);
  int JointOfColumn(int column) const {
    return column < num_joints() ? column : functions_[column - num_joints()].joint;
  }
  const double* ComputeFunctions(const Eigen::Ref<const Eigen::VectorXd>& angles,
                                 MarkerJacobian* result) const;
  void AddSlopes(int marker, MarkerJacobian* result) const;

  std::vector<int> joints_;
  std::vector<MarkerIx> markers_;
  std::vector<Function> functions_;
  bool is_plain_ = true;  ///< every link turns by an angle of its own
  bool is_root_fixed_;
  Eigen::Isometry3d X_WS_;
  std::vector<TrackedLink> links_;  // the root first, then one for each moving segment, in order
  std::vector<MarkerSite> sites_;   // by link
  std::vector<int> link_of_marker_;
  std::vector<int> segment_of_link_;
  Eigen::VectorXd lower_;
  Eigen::VectorXd upper_;
  Eigen::VectorXd rest_;
  Eigen::VectorXd reach_;
  std::vector<bool> turns_freely_;
  Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic> moves_;
};

}  // namespace mmm_converter
