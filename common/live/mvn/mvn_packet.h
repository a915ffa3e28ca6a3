// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>

namespace mmm_converter {

inline constexpr int kMvnSegments = 23;

/// The pose of an MVN segment in the world: z up [m].
using MvnPoses = std::array<Eigen::Isometry3d, kMvnSegments>;

/// Of a datagram.
struct MvnMoment {
  std::uint32_t sample = 0;
  std::uint32_t milliseconds = 0;
};

// Datagrams of the Xsens MVN network protocol, MXTP and the number of their kind, big endian: a
// header of 24 bytes and the items. Source: MVN real-time network streaming specification, N.

/// Kind 02: for each segment its number from 1, position [m] and unit quaternion w x y z, as 32-bit
/// numbers.
std::string FormatMvnPoses(const MvnMoment& moment, const MvnPoses& poses);

/// Kind 12: what the character is called; line breaks in it become blanks.
std::string FormatMvnName(const MvnMoment& moment, const std::string& name);

/// Kind 13: segments' names, as MVN's files have them, and origins [m] in the T-pose; no points.
std::string FormatMvnScale(const MvnMoment& moment, const MvnPoses& t_pose);

/// Kind 20: for each joint the points 256 * segment of parent and child, and the rotation of the
/// child's axes in the parent's [degrees], as turns about y (flexion), then x (abduction), then z
/// (rotation), in the order x, y, z. The specification does not say in which order they turn: this
/// is MVN's own of its joint angles (ISB's), and what the local numbers of points are, 0, is not
/// known here.
std::string FormatMvnJointAngles(const MvnMoment& moment, const MvnPoses& poses);

/// Kind 25: the moment's time as HH:MM:SS.mmm.
std::string FormatMvnTimeCode(const MvnMoment& moment);

}  // namespace mmm_converter
