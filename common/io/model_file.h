// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

#include "common/model/kinematic_model.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// A model, of whichever format.
struct LoadedModel {
  KinematicModel model;
  /// Of a person of 1 m and 1 kg (MMM), to be scaled. Otherwise as large as it is (URDF).
  bool is_reference = true;
  std::map<std::string, std::string> segment_of_link;  ///< of a URDF: segment names of its links
};

/// Reads an MMM or Simox model (`<Robot>` of `<RobotNode>`) or a URDF (`<robot>` of `<link>`), told
/// by its content.
/// @throws Error as ReadMmmModel and ReadUrdfModel.
LoadedModel ReadModelFile(const std::string& path, Warnings* warnings);

}  // namespace mmm_converter
