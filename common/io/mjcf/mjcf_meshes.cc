// SPDX-License-Identifier: MIT
#include "common/io/mjcf/mjcf_meshes.h"

#include <fmt/format.h>

#include <filesystem>

namespace mmm_converter {
namespace {

/// As MuJoCo: less its reference, turned, and then scaled.
Eigen::Affine3d FrameOf(const MjcfAttributes& mesh) {
  Eigen::Affine3d A = Eigen::Affine3d::Identity();
  A.scale(mesh.Vector("scale", Eigen::Vector3d::Ones()));
  if (const auto q = mesh.Numbers("refquat", 4, 4)) {
    const Eigen::Quaterniond turn((*q)[0], (*q)[1], (*q)[2], (*q)[3]);
    if (turn.norm() > 0) A.rotate(turn.normalized().conjugate());
  }
  A.translate(-mesh.Vector("refpos", Eigen::Vector3d::Zero()));
  return A;
}

}  // namespace

MjcfMeshes::MjcfMeshes(const MjcfDefaults& defaults, const MjcfSettings& settings, MjcfText* text)
    : text_(*text) {
  for (const XmlElement* assets : text_.root().FindChildren("asset")) {
    for (const XmlElement* element : assets->FindChildren("mesh")) {
      const MjcfAttributes attributes(*element, defaults.ClassOf(*element, 0, "class"), defaults,
                                      settings, text);
      std::filesystem::path file = attributes.Word("file", "");
      std::string name = attributes.Word("name", file.stem().string());
      if (name.empty()) continue;
      if (settings.strips_paths) file = file.filename();
      RobotMesh mesh;
      if (!file.empty()) mesh.file = (std::filesystem::path(settings.mesh_folder) / file).string();
      mesh.A_SM = FrameOf(attributes);
      by_name_.emplace(std::move(name), std::move(mesh));
    }
  }
}

void MjcfMeshes::Add(const MjcfAttributes& geom, const Eigen::Isometry3d& X_BG, bool touches,
                     int body, const XmlElement& element, std::vector<RobotMesh>* meshes) const {
  const std::string name = geom.Word("mesh", "");
  if (name.empty()) return;
  const auto asset = by_name_.find(name);
  if (asset == by_name_.end()) {
    text_.Warn(element, fmt::format("<geom mesh=\"{}\">: no <mesh> of <asset> is called so", name));
    return;
  }
  RobotMesh& mesh = meshes->emplace_back(asset->second);
  mesh.segment = body;
  mesh.A_SM = X_BG * mesh.A_SM;
  mesh.touches = touches;
}

}  // namespace mmm_converter
