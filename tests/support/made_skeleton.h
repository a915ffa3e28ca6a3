// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/model/kinematic_model.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter::testing {

/// How a program would write a person as a skeleton.
struct SkeletonStyle {
  enum class Zero { kT, kA, kAllAlongX };  ///< the pose in which all angles are 0
  enum class Names { kLafan, kXsens, kSmpl };
  std::string order = "ZYX";  ///< of the rotations
  Zero zero = Zero::kT;
  Names names = Names::kLafan;
  double unit = 0.01;        ///< [m]
  bool has_y_up = true;      ///< else z
  bool moves_bones = false;  ///< with position channels on each joint
};

struct MadeSkeleton {
  std::string bvh;
  std::vector<std::string> names;        ///< of its joints
  std::vector<Eigen::Matrix3Xd> places;  ///< of them in each frame [m], z up
};

/// A person of the reference model in motion as BVH.
MadeSkeleton MakeSkeleton(const KinematicModel& person, const PoseTrajectory& motion,
                          const SkeletonStyle& style);

}  // namespace mmm_converter::testing
