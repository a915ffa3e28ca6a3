// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "common/model/kinematic_model.h"
#include "common/support/warnings.h"

namespace mmm_converter {

inline constexpr std::size_t kMaxModelBytes = std::size_t{8} << 20;  ///< a real model has 0.1 MB

/// Reads a model in MMM's or Simox's robot XML (`<Robot>` of `<RobotNode>`). Lengths are in mm and
/// angles in rad where the file names no unit. Markers are the `<Sensor type="position">` of the
/// nodes. The floating root is the node `root_joint`, otherwise the file's RootNode; virtual nodes
/// above it are left out. Prismatic nodes stay at 0: their upper limit only records the length of
/// the segment, and a warning names each node where it differs from the node's offset.
/// @throws Error with all errors of the file.
KinematicModel ReadMmmModel(const std::string& path, Warnings* warnings = nullptr);

/// As ReadMmmModel; `file` is only named in messages.
KinematicModel ParseMmmModel(std::string_view content, const std::string& file,
                             Warnings* warnings = nullptr);

}  // namespace mmm_converter
