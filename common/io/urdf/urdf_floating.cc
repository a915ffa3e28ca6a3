// SPDX-License-Identifier: MIT
#include "common/io/urdf/urdf_floating.h"

#include <algorithm>
#include <optional>

namespace mmm_converter {
namespace {

std::optional<int> FloatingJoint(const UrdfDocument& document) {
  std::optional<int> floating;
  for (std::size_t i = 0; i < document.joints.size(); ++i) {
    if (document.joints[i].parent != document.root) continue;
    if (floating || document.joints[i].type != UrdfJointType::kFloating) return {};
    floating = static_cast<int>(i);
  }
  if (document.links[static_cast<std::size_t>(document.root)].mass != 0) return {};
  return floating;
}

void MoveUp(int removed, int* index) {
  if (*index > removed) --*index;
}

}  // namespace

void RemoveFloatingWorld(UrdfDocument* document) {
  const std::optional<int> floating = FloatingJoint(*document);
  if (!floating) return;
  const int world = document->root;
  document->root = document->joints[static_cast<std::size_t>(*floating)].child;
  document->links[static_cast<std::size_t>(document->root)].parent_joint = -1;
  document->links.erase(document->links.begin() + world);
  document->joints.erase(document->joints.begin() + *floating);
  MoveUp(world, &document->root);
  for (UrdfLink& link : document->links) MoveUp(*floating, &link.parent_joint);
  for (UrdfJoint& joint : document->joints) {
    MoveUp(world, &joint.parent);
    MoveUp(world, &joint.child);
  }
  std::erase_if(document->shapes, [&](const ContactShape& one) { return one.segment == world; });
  std::erase_if(document->meshes, [&](const RobotMesh& one) { return one.segment == world; });
  for (ContactShape& shape : document->shapes) MoveUp(world, &shape.segment);
  for (RobotMesh& mesh : document->meshes) MoveUp(world, &mesh.segment);
}

}  // namespace mmm_converter
