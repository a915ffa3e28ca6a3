// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "common/io/mjcf/mjcf_text.h"
#include "common/model/robot.h"

namespace mmm_converter {

inline constexpr std::size_t kMaxMjcfBodies = 4096;  ///< the largest robots have some hundreds
inline constexpr std::size_t kMaxMjcfShapes = 100'000;

/// A `<joint>`: a hinge, or a slide. Its value q moves the body by q - ref.
struct MjcfJoint {
  std::string name;
  int line = 0;
  bool slides = false;
  Eigen::Vector3d anchor = Eigen::Vector3d::Zero();  ///< in the body's frame [m]
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();   ///< unit vector there
  bool is_limited = false;
  double lower = 0, upper = 0;  ///< [rad, m]
  double ref = 0;               ///< [rad, m]
  double effort = 0;            ///< the most of what moves it [N m, N]; 0: not known
};

struct MjcfBody {
  std::string name;  ///< never empty: those without are called by their number
  int line = 0;
  int parent = -1;                                         ///< index of a body; -1: the world
  Eigen::Isometry3d X_PB = Eigen::Isometry3d::Identity();  ///< [m]
  bool is_free = false;           ///< has a free joint, or six that are one; X_PB is its start
  bool is_moved = false;          ///< a mocap body, which is no robot's
  std::vector<MjcfJoint> joints;  ///< in the order in which they act
  double mass = 0;                ///< [kg]
  Eigen::Vector3d p_BC = Eigen::Vector3d::Zero();     ///< centre of mass [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about it, in B [kg m^2]
};

/// `<equality><joint>`: q1 - ref1 = sum of p_k (q2 - ref2)^k.
struct MjcfCoupling {
  std::string follower, leader;  ///< no leader: the constant alone
  std::array<double, 5> polynomial = {0, 1, 0, 0, 0};
};

/// `<equality><connect>` or `<weld>` of two bodies: a loop, which is not followed.
using MjcfTie = std::array<std::string, 2>;

/// The bodies of an MJCF, depth first, in the order of the file, which is that of MuJoCo.
struct MjcfDocument {
  std::string name;  ///< empty: none
  std::vector<MjcfBody> bodies;
  std::vector<ContactShape> shapes;  ///< `segment` is the index of a body
  std::vector<RobotMesh> meshes;     ///< so, too
  std::vector<Robot::Site> sites;    ///< so, too
  std::vector<MjcfCoupling> couplings;
  std::vector<MjcfTie> ties;
};

/// Reads what moves, touches and has mass. Errors are of the text: what would move the robot in
/// ways that are not read is one by its name.
MjcfDocument ReadMjcfDocument(MjcfText* text);

}  // namespace mmm_converter
