// SPDX-License-Identifier: MIT
#include "common/io/robot/robot_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "common/motion/body_poses.h"
#include "common/motion/resampled.h"
#include "common/motion/trajectory_derivatives.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

/// With all joints of the model, in its order.
PoseTrajectory WithAllJoints(const KinematicModel& model, const PoseTrajectory& trajectory) {
  PoseTrajectory whole;
  whole.rate = trajectory.rate;
  whole.first_time = trajectory.first_time;
  for (int i = 0; i < model.num_joints(); ++i) whole.joint_names.push_back(model.joint(i).name);
  std::vector<int> joints;
  for (const std::string& name : trajectory.joint_names) {
    joints.push_back(model.FindJoint(name));
    if (joints.back() >= 0) continue;
    throw Error(
        fmt::format("the motion has a joint '{}', and robot {} has none", name, model.name()));
  }
  const Posture zero = ZeroPosture(model);
  whole.postures.reserve(trajectory.postures.size());
  for (const Posture& posture : trajectory.postures) {
    Posture& added = whole.postures.emplace_back(posture);
    added.joint_angles = zero.joint_angles;
    for (std::size_t i = 0; i < joints.size(); ++i) {
      added.joint_angles[joints[i]] = posture.joint_angles[static_cast<Eigen::Index>(i)];
    }
  }
  return whole;
}

JointBounds BoundsOf(const Robot& robot) {
  JointBounds bounds;
  const int num_joints = robot.model.num_joints();
  bounds.lower.resize(num_joints);
  bounds.upper.resize(num_joints);
  for (int i = 0; i < num_joints; ++i) {
    bounds.lower[i] = robot.model.joint(i).lower;
    bounds.upper[i] = robot.model.joint(i).upper;
  }
  bounds.velocity = robot.velocity_limits;
  return bounds;
}

PoseTrajectory AtRate(PoseTrajectory whole, const JointBounds& bounds, std::optional<double> rate) {
  if (whole.postures.empty()) throw Error("the motion has no frames");
  if (rate && *rate != whole.rate) whole = Resample(whole, *rate, bounds);
  Differentiate(&whole);
  return whole;
}

PoseTrajectory AtRate(const Robot& robot, const PoseTrajectory& trajectory,
                      std::optional<double> rate) {
  return AtRate(WithAllJoints(robot.model, trajectory), BoundsOf(robot), rate);
}

/// With room for the positions of joints.
RobotMotion MoveRoot(const PoseTrajectory& whole) {
  const Eigen::Index frames = whole.num_frames();
  RobotMotion motion;
  motion.rate = whole.rate;
  motion.root_positions.resize(3, frames);
  motion.root_quaternions.resize(4, frames);
  motion.joint_positions.resize(0, frames);
  motion.joint_velocities.resize(0, frames);
  motion.root_velocities = whole.velocities.topRows<3>();
  motion.root_angular_velocities = whole.velocities.middleRows<3>(3);
  for (Eigen::Index k = 0; k < frames; ++k) {
    const Posture& posture = whole.postures[static_cast<std::size_t>(k)];
    const Eigen::Quaterniond q = posture.orientation.normalized();
    motion.root_positions.col(k) = posture.position;
    motion.root_quaternions.col(k) << q.w(), q.x(), q.y(), q.z();
  }
  return motion;
}

/// Joints above each segment that move it, the segment's own counted.
std::vector<int> Depths(const KinematicModel& model) {
  std::vector<int> depths;
  for (const Segment& segment : model.segments()) {
    const int above = segment.parent < 0 ? 0 : depths[static_cast<std::size_t>(segment.parent)];
    depths.push_back(above + (segment.joint >= 0 ? 1 : 0));
  }
  return depths;
}

void Sort(const KinematicModel& model, RobotOrder order, const std::vector<int>& segment_of,
          std::vector<int>* indices) {
  if (order == RobotOrder::kDepthFirst) return;
  const std::vector<int> depths = Depths(model);
  const auto depth = [&](int i) {
    return depths[static_cast<std::size_t>(segment_of[static_cast<std::size_t>(i)])];
  };
  std::stable_sort(indices->begin(), indices->end(),
                   [&](int a, int b) { return depth(a) < depth(b); });
}

/// The shortest way from quaternion to quaternion.
void RemoveSignJumps(Eigen::MatrixXd* quaternions) {
  for (Eigen::Index k = 1; k < quaternions->cols(); ++k) {
    for (Eigen::Index i = 0; i < quaternions->rows(); i += 4) {
      auto q = quaternions->col(k).segment<4>(i);
      if (q.dot(quaternions->col(k - 1).segment<4>(i)) < 0) q = -q;
    }
  }
}

std::vector<int> MovingSegments(const KinematicModel& model) {
  std::vector<int> segments;
  for (std::size_t i = 0; i < model.segments().size(); ++i) {
    if (model.segments()[i].joint >= 0) segments.push_back(static_cast<int>(i));
  }
  return segments;
}

}  // namespace

RobotMotion MakeRobotMotion(const Robot& robot, const PoseTrajectory& trajectory,
                            std::optional<double> rate, RobotOrder order) {
  const PoseTrajectory whole = AtRate(robot, trajectory, rate);
  const KinematicModel& model = robot.model;
  const Eigen::Index frames = whole.num_frames();
  RobotMotion motion = MoveRoot(whole);
  motion.is_root_fixed = model.is_root_fixed();
  std::vector<int> all(model.segments().size());
  std::iota(all.begin(), all.end(), 0);
  motion.joint_segments = MovingSegments(model);
  Sort(model, order, all, &motion.joint_segments);
  const auto num_joints = static_cast<Eigen::Index>(motion.joint_segments.size());
  motion.joint_positions.resize(num_joints, frames);
  motion.joint_velocities.resize(num_joints, frames);
  RemoveSignJumps(&motion.root_quaternions);
  for (Eigen::Index i = 0; i < num_joints; ++i) {
    const Segment& segment = model.segments()[static_cast<std::size_t>(
        motion.joint_segments[static_cast<std::size_t>(i)])];
    motion.joints.push_back(segment.name);
    for (Eigen::Index k = 0; k < frames; ++k) {
      double value = whole.postures[static_cast<std::size_t>(k)].joint_angles[segment.joint];
      double slope = 1;
      if (segment.leader >= 0 && segment.function) value = segment.function->Value(value, &slope);
      motion.joint_positions(i, k) = value;
      motion.joint_velocities(i, k) = slope * whole.velocities(6 + segment.joint, k);
    }
  }
  return motion;
}

RobotMotion MakeObjectMotion(const PoseTrajectory& poses, std::optional<double> rate) {
  RobotMotion motion = MoveRoot(AtRate(poses, {}, rate));
  RemoveSignJumps(&motion.root_quaternions);
  return motion;
}

std::vector<int> AllLinks(const Robot& robot) {
  std::vector<int> links(robot.links.size());
  std::iota(links.begin(), links.end(), 0);
  return links;
}

std::vector<int> MovingLinks(const Robot& robot, RobotOrder order) {
  std::vector<int> links, segment_of;
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const Robot::Link& link = robot.links[i];
    segment_of.push_back(link.segment);
    const bool moves = robot.model.segments()[static_cast<std::size_t>(link.segment)].joint >= 0;
    // A link that is no segment of its own is fixed to that of its parent.
    const bool is_own = link.parent < 0 ||
                        robot.links[static_cast<std::size_t>(link.parent)].segment != link.segment;
    if (link.parent < 0 || (moves && is_own)) links.push_back(static_cast<int>(i));
  }
  Sort(robot.model, order, segment_of, &links);
  return links;
}

LinkPoses MakeLinkPoses(const Robot& robot, const PoseTrajectory& trajectory,
                        std::optional<double> rate, const std::vector<int>& links,
                        bool relative_to_root) {
  const PoseTrajectory whole = AtRate(robot, trajectory, rate);
  BodySelection selection;
  selection.relative_to_root = relative_to_root;
  LinkPoses poses;
  for (const int link : links) {
    selection.segments.push_back(robot.links[static_cast<std::size_t>(link)].segment);
    poses.names.push_back(robot.links[static_cast<std::size_t>(link)].name);
  }
  BodyPoses of_segments = ComputeBodyPoses(robot.model, whole, selection);
  poses.positions = std::move(of_segments.positions);
  poses.quaternions = std::move(of_segments.quaternions);
  if (!relative_to_root) {
    poses.velocities = std::move(of_segments.velocities);
    poses.angular_velocities = std::move(of_segments.angular_velocities);
  }
  for (std::size_t i = 0; i < links.size(); ++i) {
    const Eigen::Isometry3d& X_SL = robot.links[static_cast<std::size_t>(links[i])].X_SL;
    if (X_SL.matrix() == Eigen::Matrix4d::Identity()) continue;
    const auto at = static_cast<Eigen::Index>(i);
    for (Eigen::Index k = 0; k < poses.positions.cols(); ++k) {
      auto q = poses.quaternions.col(k).segment<4>(4 * at);
      const Eigen::Quaterniond q_S(q[0], q[1], q[2], q[3]);
      const Eigen::Vector3d arm = q_S * X_SL.translation();
      const Eigen::Quaterniond q_L = q_S * Eigen::Quaterniond(X_SL.linear());
      poses.positions.col(k).segment<3>(3 * at) += arm;
      q << q_L.w(), q_L.x(), q_L.y(), q_L.z();
      if (relative_to_root) continue;
      const Eigen::Vector3d w = poses.angular_velocities.col(k).segment<3>(3 * at);
      poses.velocities.col(k).segment<3>(3 * at) += w.cross(arm);
    }
  }
  RemoveSignJumps(&poses.quaternions);
  return poses;
}

}  // namespace mmm_converter
