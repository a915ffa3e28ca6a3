// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

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

/// marker_file: of a set of markers for the model, in its format; empty: none. Nothing: it is no
/// model of that format, or there is no such set of markers.
/// @throws Error
using ModelReader = std::optional<LoadedModel>(const std::string& path,
                                               const std::string& marker_file, Warnings* warnings);
/// Of models in formats of parts (common/part_formats.cc).
const std::vector<ModelReader*>& PartModelReaders();

/// Reads an MMM or Simox model (`<Robot>` of `<RobotNode>`), or one that PartModelReaders knows,
/// told by its content. marker_file: a MarkerSet of OpenSim, whose markers come to such a model;
/// empty: none.
/// @throws Error as ReadMmmModel and these.
LoadedModel ReadModelFile(const std::string& path, Warnings* warnings,
                          const std::string& marker_file = {});

}  // namespace mmm_converter
