// SPDX-License-Identifier: MIT
#include "common/motion/body_poses.h"

#include <algorithm>
#include <cmath>

#include "common/model/forward_kinematics.h"
#include "common/motion/marker_synthesis.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kSameFrame = 1e-3;  // [frames], for the rounding of times

struct Twist {
  Vector3d v = Vector3d::Zero();  // of the origin [m/s], W
  Vector3d w = Vector3d::Zero();  // [rad/s], W
};

// Of all segments; angles: of all joints; column: of PoseTrajectory::velocities. joint_rows: row of
// each joint of the model, -1 where it does not move.
std::vector<Twist> SegmentTwists(const KinematicModel& model, const std::vector<Isometry3d>& X_WS,
                                 const Eigen::VectorXd& angles,
                                 const Eigen::Ref<const Eigen::VectorXd>& column,
                                 const std::vector<int>& joint_rows) {
  std::vector<Twist> twists(X_WS.size());
  twists[0] = {column.head<3>(), column.segment<3>(3)};
  for (std::size_t i = 1; i < X_WS.size(); ++i) {
    const Segment& segment = model.segments()[i];
    const Twist& parent = twists[segment.parent];
    const Vector3d arm = X_WS[i].translation() - X_WS[segment.parent].translation();
    twists[i] = {parent.v + parent.w.cross(arm), parent.w};
    const int row = segment.joint < 0 ? -1 : joint_rows[segment.joint];
    if (row < 0) continue;
    double slope = 1;
    if (segment.function) segment.function->Value(angles[segment.joint], &slope);
    // The axis is the same before and behind the joint.
    const Vector3d rate = slope * column[row] * (X_WS[i].linear() * segment.axis);
    (segment.type == JointType::kSliding ? twists[i].v : twists[i].w) += rate;
  }
  return twists;
}

std::vector<int> VelocityRows(const KinematicModel& model, const PoseTrajectory& motion) {
  std::vector<int> rows(model.num_joints(), -1);
  for (std::size_t i = 0; i < motion.joint_names.size(); ++i) {
    const int joint = model.FindJoint(motion.joint_names[i]);
    if (joint >= 0) rows[joint] = 6 + static_cast<int>(i);
  }
  return rows;
}

Eigen::Vector4d QuaternionOf(const Eigen::Matrix3d& R) {
  if (!R.allFinite()) return Eigen::Vector4d::Constant(kNaN);
  const Eigen::Quaterniond q(R);
  return {q.w(), q.x(), q.y(), q.z()};
}

// Fills one frame after the other.
class PoseTable {
 public:
  PoseTable(const KinematicModel& model, const PoseTrajectory& motion,
            const BodySelection& selection)
      : model_(model),
        motion_(motion),
        selection_(selection),
        joint_rows_(VelocityRows(model, motion)),
        total_mass_(model.total_mass()) {
    const bool has_velocities = motion.velocities.size() > 0;
    const Eigen::Index frames = motion.num_frames();
    poses_.rate = motion.rate;
    poses_.first_time = motion.first_time;
    poses_.relative_to_root = selection.relative_to_root;
    for (const int s : selection.segments) poses_.segments.push_back(model.segments()[s].name);
    for (const ObjectMotion& object : selection.objects) poses_.objects.push_back(object.name);
    for (const ModelPoint& point : selection.points) poses_.points.push_back(point.name);
    const Eigen::Index bodies = poses_.num_bodies();
    const auto segments = static_cast<Eigen::Index>(poses_.segments.size());
    const auto points = static_cast<Eigen::Index>(poses_.points.size());
    poses_.positions.resize(3 * bodies, frames);
    poses_.quaternions.resize(4 * bodies, frames);
    poses_.point_positions.resize(3 * points, frames);
    if (total_mass_ > 0) poses_.center_of_mass.resize(3, frames);
    if (!has_velocities) return;
    poses_.velocities.resize(3 * segments, frames);
    poses_.angular_velocities.resize(3 * segments, frames);
    poses_.point_velocities.resize(3 * points, frames);
    if (total_mass_ > 0) poses_.center_of_mass_velocity.resize(3, frames);
  }

  void Fill(int k) {
    posture_ = ModelPosture(model_, motion_, k);
    X_WS_ = SegmentPoses(model_, posture_);
    const Isometry3d X_BW =
        selection_.relative_to_root ? X_WS_[0].inverse() : Isometry3d::Identity();
    int body = 0;
    for (const int s : selection_.segments) PutBody(X_BW * X_WS_[s], body++, k);
    for (const ObjectMotion& object : selection_.objects) {
      PutBody(X_BW * PoseAt(object.trajectory, motion_.time(k)), body++, k);
    }
    for (std::size_t i = 0; i < selection_.points.size(); ++i) {
      poses_.point_positions.col(k).segment<3>(3 * static_cast<Eigen::Index>(i)) =
          X_BW * X_WS_[selection_.points[i].segment].translation();
    }
    if (total_mass_ > 0) {
      poses_.center_of_mass.col(k) = X_BW * MassMean([&](std::size_t i) -> Vector3d {
                                       return X_WS_[i] * model_.segments()[i].p_SB;
                                     });
    }
    if (motion_.velocities.size() > 0) FillVelocities(k);
  }

  BodyPoses Take() { return std::move(poses_); }

 private:
  void PutBody(const Isometry3d& X, int body, int k) {
    poses_.positions.col(k).segment<3>(3 * body) = X.translation();
    Eigen::Vector4d q = QuaternionOf(X.linear());
    if (k > 0 && q.dot(poses_.quaternions.col(k - 1).segment<4>(4 * body)) < 0) q = -q;
    poses_.quaternions.col(k).segment<4>(4 * body) = q;
  }

  template <typename Quantity>
  Vector3d MassMean(const Quantity& quantity) const {
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 0; i < X_WS_.size(); ++i) {
      const double mass = model_.segments()[i].mass;
      if (mass > 0) sum += mass * quantity(i);
    }
    return sum / total_mass_;
  }

  void FillVelocities(int k) {
    const std::vector<Twist> twists =
        SegmentTwists(model_, X_WS_, posture_.joint_angles, motion_.velocities.col(k), joint_rows_);
    const bool is_relative = selection_.relative_to_root;
    const Eigen::Matrix3d R_BW = X_WS_[0].linear().transpose();
    const Vector3d origin = X_WS_[0].translation();
    // As seen from the frame B of a point at p that moves with v in W.
    const auto seen = [&](const Vector3d& p, const Vector3d& v) -> Vector3d {
      if (!is_relative) return v;
      return R_BW * (v - twists[0].v - twists[0].w.cross(p - origin));
    };
    Eigen::Index row = 0;
    for (const int s : selection_.segments) {
      poses_.velocities.col(k).segment<3>(row) = seen(X_WS_[s].translation(), twists[s].v);
      poses_.angular_velocities.col(k).segment<3>(row) =
          is_relative ? R_BW * (twists[s].w - twists[0].w) : twists[s].w;
      row += 3;
    }
    row = 0;
    for (const ModelPoint& point : selection_.points) {
      poses_.point_velocities.col(k).segment<3>(row) =
          seen(X_WS_[point.segment].translation(), twists[point.segment].v);
      row += 3;
    }
    if (total_mass_ <= 0) return;
    poses_.center_of_mass_velocity.col(k) = MassMean([&](std::size_t i) -> Vector3d {
      const Vector3d arm = X_WS_[i].linear() * model_.segments()[i].p_SB;
      return seen(X_WS_[i].translation() + arm, twists[i].v + twists[i].w.cross(arm));
    });
  }

  const KinematicModel& model_;
  const PoseTrajectory& motion_;
  const BodySelection& selection_;
  std::vector<int> joint_rows_;
  double total_mass_ = 0;
  Posture posture_;               // of the frame, all joints
  std::vector<Isometry3d> X_WS_;  // of the frame that is filled
  BodyPoses poses_;
};

}  // namespace

Isometry3d PoseAt(const PoseTrajectory& body, double time) {
  double frame = (time - body.first_time) * body.rate;
  if (std::abs(frame - std::round(frame)) < kSameFrame) frame = std::round(frame);
  Isometry3d X = Isometry3d::Identity();
  if (!(frame >= 0 && frame <= body.num_frames() - 1)) {
    X.matrix().setConstant(kNaN);
    return X;
  }
  const int k = static_cast<int>(frame);
  const double share = frame - k;
  const Posture& q0 = body.postures[k];
  const Posture& q1 = body.postures[share > 0 ? k + 1 : k];
  X.linear() = q0.orientation.slerp(share, q1.orientation).toRotationMatrix();
  X.translation() = (1 - share) * q0.position + share * q1.position;
  return X;
}

BodyPoses ComputeBodyPoses(const KinematicModel& model, const PoseTrajectory& motion,
                           const BodySelection& selection) {
  PoseTable table(model, motion, selection);
  for (int k = 0; k < motion.num_frames(); ++k) table.Fill(k);
  return table.Take();
}

}  // namespace mmm_converter
