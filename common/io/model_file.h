// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <memory>
#include <string>

#include "common/model/kinematic_model.h"
#include "common/model/subject.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// A model, of whichever format.
struct LoadedModel {
  KinematicModel model;
  /// Of a person of 1 m and 1 kg (MMM), to be scaled. Otherwise as large as it is.
  bool is_reference = true;
  std::map<std::string, std::string> segment_of_link;  ///< of a robot: segment names of its links
  std::shared_ptr<const Subject> subject = nullptr;    ///< as which the model was calibrated
};

/// Reads an MMM or Simox model (`<Robot>` of `<RobotNode>`), a URDF (`<robot>` of `<link>`), an
/// MJCF (`<mujoco>`) or a model of OpenSim, told by its content. marker_file: a MarkerSet of
/// OpenSim, whose markers come to such a model; empty: none.
/// @throws Error as ReadMmmModel, ReadUrdfModel, ReadMjcf and ReadOsimModel.
LoadedModel ReadModelFile(const std::string& path, Warnings* warnings,
                          const std::string& marker_file = {});

}  // namespace mmm_converter
