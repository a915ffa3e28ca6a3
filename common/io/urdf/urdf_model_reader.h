// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "common/model/kinematic_model.h"
#include "common/support/warnings.h"

namespace mmm_converter {

struct UrdfModel {
  /// A segment for each link, named by the joint that carries it; the root by its link.
  KinematicModel model;
  std::map<std::string, std::string> segment_of_link;
};

/// Reads a URDF (urdfdom). Its root floats. Fixed links called `<label>_marker` are markers
/// `label`; they stay segments only where they have a mass or children. Continuous joints, and
/// revolute ones whose limits are wider than 4 pi to both sides, have none. KinematicModel couples
/// no joints and slides none: mimic joints are held at their offset, prismatic joints at 0 or at
/// their limit nearest to it. A warning names each of these. Markers below a mimic joint, which
/// would pull all else towards where it is held, are left out, with a warning too.
/// @throws Error as ParseUrdf, and for planar and floating joints.
UrdfModel ReadUrdfModel(const std::string& path, Warnings* warnings = nullptr);

/// As ReadUrdfModel; `file` is only named in messages.
UrdfModel ParseUrdfModel(std::string_view content, const std::string& file,
                         Warnings* warnings = nullptr);

}  // namespace mmm_converter
