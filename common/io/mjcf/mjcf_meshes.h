// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/io/mjcf/mjcf_values.h"
#include "common/model/robot.h"

namespace mmm_converter {

/// The meshes of `<asset>`, by which geoms name them.
class MjcfMeshes {
 public:
  MjcfMeshes(const MjcfDefaults& defaults, const MjcfSettings& settings, MjcfText* text);

  /// Appends the mesh of a geom that names one; X_BG: of the geom in the body. One that is not
  /// among the assets is left out, with a warning.
  void Add(const MjcfAttributes& geom, const Eigen::Isometry3d& X_BG, bool touches, int body,
           const XmlElement& element, std::vector<RobotMesh>* meshes) const;

 private:
  MjcfText& text_;
  std::map<std::string, RobotMesh> by_name_;
};

}  // namespace mmm_converter
