// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <string_view>

namespace mmm_converter {

inline constexpr std::size_t kMaxMeshBytes = std::size_t{32} << 20;  ///< parts of robots have 1 MB
inline constexpr Eigen::Index kMaxMeshPoints = 1'000'000;

/// The corners of all triangles of a mesh, in the axes of its file.
struct MeshPoints {
  Eigen::Matrix3Xd points;  ///< of Collada, which knows its unit, [m]
  bool is_y_up = false;     ///< as Collada says, or says nothing; other formats do not know
};

/// Parses STL, OBJ or Collada (assimp), as the ending of `file` says. Nothing else is opened: no
/// materials, no pictures.
/// @throws Error with the file: another ending, not of its format, too many corners, none, or
///         numbers that are none.
MeshPoints ParseMesh(std::string_view content, const std::string& file);

/// @throws Error as ReadFileContent and ParseMesh.
MeshPoints ReadMesh(const std::string& path);

}  // namespace mmm_converter
