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

/// A datagram MXTP02 (quaternion poses) of the Xsens MVN network protocol, big endian: header of 24
/// bytes, then for each segment its number from 1, position [m] and unit quaternion w x y z, as
/// 32-bit numbers. Source: MVN real-time network streaming specification.
std::string FormatMvnPacket(std::uint32_t sample, std::uint32_t milliseconds,
                            const MvnPoses& poses);

}  // namespace mmm_converter
