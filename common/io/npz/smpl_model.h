// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

namespace mmm_converter {

/// Bodies of the SMPL family whose zero poses differ.
enum class SmplKind {
  kSmplH,  ///< SMPL, too
  kSmplX,
};

struct SmplJoint {
  const char* name;
  int parent;
};

inline constexpr int kSmplJoints = 22;

/// The joints of the body, which SMPL, SMPL-H and SMPL-X begin with.
const std::array<SmplJoint, kSmplJoints>& SmplJoints();

/// Where the joints are at the zero pose, by the shape: x left, y up, z to the front.
struct SmplModel {
  Eigen::Matrix3Xd joints;                   ///< of the mean shape [m]
  std::vector<Eigen::Matrix3Xd> directions;  ///< how a unit of each beta moves them
  int num_joints = 52;                       ///< with those of hands and face

  Eigen::Matrix3Xd Joints(const std::vector<double>& betas) const;
};

/// A person of 1.7 m with the proportions of the MMM model, whose bones at the zero pose have the
/// directions that the kind's have.
SmplModel StandInSmplModel(SmplKind kind);

/// Of the user's own body model (.npz): v_template, shapedirs and J_regressor.
/// @throws Error as NpzFile, and where it is none.
SmplModel ReadSmplModel(const std::string& file);

}  // namespace mmm_converter
