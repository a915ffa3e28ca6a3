// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <string_view>
#include <vector>

#include "common/model/robot.h"
#include "common/support/diagnostics.h"

namespace mmm_converter {

inline constexpr std::size_t kMaxUrdfLinks = 4096;  ///< the largest robots have some hundreds

/// A `<link>` of a URDF.
struct UrdfLink {
  std::string name;
  int line = 0;
  int parent_joint = -1;                              ///< -1: the root
  double mass = 0;                                    ///< [kg]
  Eigen::Vector3d p_LB = Eigen::Vector3d::Zero();     ///< centre of mass in the link's frame [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about it, in axes of the link [kg m^2]
};

enum class UrdfJointType { kFixed, kRevolute, kContinuous, kPrismatic, kFloating, kPlanar };

/// A `<joint>` of a URDF. The child link's frame is the joint's.
struct UrdfJoint {
  std::string name;
  int line = 0;
  UrdfJointType type = UrdfJointType::kFixed;
  int parent = -1;                                         ///< index of the link
  int child = -1;                                          ///< index of the link
  Eigen::Isometry3d X_PF = Eigen::Isometry3d::Identity();  ///< [m]
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();         ///< unit vector in F
  double lower = 0;                                        ///< [rad], prismatic [m]
  double upper = 0;                                        ///< [rad], prismatic [m]
  std::string mimicked;                                    ///< `<mimic joint="">`; empty: none
  double mimic_offset = 0;                                 ///< [rad], prismatic [m]
  double mimic_multiplier = 1;
  double velocity = 0;  ///< the fastest [rad/s], prismatic [m/s]; 0: not known
  double effort = 0;    ///< the most [N m], prismatic [N]; 0: not known
};

/// The tree of a URDF: links and joints in the order of the file, without looks and sensors.
struct UrdfDocument {
  std::string name;
  std::vector<UrdfLink> links;
  std::vector<UrdfJoint> joints;
  int root = -1;  ///< index of the link; not the world's that only carries it by a floating joint
  /// Shapes of `<collision>`, `segment` being the index of the link.
  std::vector<ContactShape> shapes;
  std::vector<RobotMesh> meshes;  ///< of `<collision>` and `<visual>`, so, too
};

/// Parses a URDF with urdfdom. What is suspicious, but can be used, is a warning of diagnostics.
/// @throws Error with the file of diagnostics: not XML, no URDF, what urdfdom refuses (with its
///         reasons), no tree, numbers that no robot has.
UrdfDocument ParseUrdf(std::string_view content, Diagnostics* diagnostics);

}  // namespace mmm_converter
