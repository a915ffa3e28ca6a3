// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

namespace mmm_converter::testing {

struct StrictBvhJoint {
  std::string name;
  int parent = -1;
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< [cm]
  std::vector<std::string> channels;                 ///< of an End Site: none
  int first_channel = 0;                             ///< in a frame's numbers
};

struct StrictBvh {
  std::vector<StrictBvhJoint> joints;  ///< parents first; End Sites are called PARENT_end
  double frame_time = 0;               ///< [s]
  std::vector<std::vector<double>> frames;

  int Find(const std::string& name) const;  ///< -1: there is none
  /// Where all joints are: translations and rotations in the order of their channels. [cm]
  std::vector<Eigen::Vector3d> Places(std::size_t frame) const;
};

/// HIERARCHY, one ROOT with six channels, JOINTs with three rotations about Z, X and Y, an End Site
/// in what has no child, unique names without blanks; MOTION, Frames, Frame Time, and in each frame
/// as many finite numbers as there are channels. Shares no code with the product.
/// @throws std::runtime_error
StrictBvh ReadStrictBvh(std::string_view text);

}  // namespace mmm_converter::testing
