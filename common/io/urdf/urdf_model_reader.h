// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "common/io/urdf/urdf_document.h"
#include "common/model/kinematic_model.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// By its root. Simox models are `<Robot>` in any case, with nodes instead of links.
bool IsUrdf(std::string_view content);

struct UrdfModel {
  /// A segment for each link, named by the joint that carries it; the root by its link.
  KinematicModel model;
  std::map<std::string, std::string> segment_of_link;
};

/// Reads a URDF (urdfdom). Its root floats; a floating joint under a root without mass is that
/// root. Fixed links called `<label>_marker` are markers `label`; they stay segments only where
/// they have a mass or children. Continuous joints, and revolute ones whose limits are wider than 4
/// pi to both sides, have none. Joints that mimic one that turns follow it. Prismatic joints are
/// held at 0 or at their limit nearest to it, with a warning that names them.
/// @throws Error as ParseUrdf, and for planar and other floating joints.
UrdfModel ReadUrdfModel(const std::string& path, Warnings* warnings = nullptr);

/// The model of a document, as ReadUrdfModel makes it.
UrdfModel MakeUrdfModel(const UrdfDocument& document, Diagnostics* diagnostics);

/// As ReadUrdfModel; `file` is only named in messages.
UrdfModel ParseUrdfModel(std::string_view content, const std::string& file,
                         Warnings* warnings = nullptr);

}  // namespace mmm_converter
