// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

namespace mmm_converter {

struct FoundMesh {
  std::string path;
  bool is_elsewhere = false;  ///< than the robot's file says
};

/// Whether the name is an address on a network, which is not fetched.
bool IsFarAway(const std::string& name);

/// The file that a robot's file calls so: `package://NAME/...` in the folder NAME above that file,
/// beside those, or in $ROS_PACKAGE_PATH or $AMENT_PREFIX_PATH; `file://...`; else relative to that
/// file. If it is not there, a file that the last parts of the name tell, in the folder of the
/// robot's file or the two above, or in `meshes` there, as copies often have only some folders.
/// Nothing: none is there.
std::optional<FoundMesh> FindMeshFile(const std::string& name, const std::string& robot_file);

}  // namespace mmm_converter
