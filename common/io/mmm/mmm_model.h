// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/model/kinematic_model.h"

namespace mmm_converter {

inline constexpr std::size_t kMaxModelBytes = std::size_t{8} << 20;  ///< a real model has 0.1 MB

struct MmmModel {
  KinematicModel model;
  std::vector<std::string> warnings;  ///< each as `file:line: message`
};

/// Reads a model in MMM's or Simox's robot XML (<Robot> of <RobotNode>). Lengths are in mm and
/// angles in rad where the file names no unit. Markers are the <Sensor type="position"> of the
/// nodes. The floating root is the node `root_joint`, otherwise the file's RootNode; virtual nodes
/// above it are left out. Prismatic nodes stay at 0: their upper limit only records the length of
/// the segment, and a warning names each node where it differs from the node's offset.
/// @throws Error with all errors of the file.
MmmModel ReadMmmModel(const std::string& path);

/// As ReadMmmModel; `file` is only named in messages.
MmmModel ParseMmmModel(std::string_view content, const std::string& file);

}  // namespace mmm_converter
