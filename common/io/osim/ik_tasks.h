// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/io/xml/xml_document.h"
#include "common/model/coordinate_task.h"
#include "common/support/diagnostics.h"

namespace mmm_converter {

/// What OpenSim's inverse kinematics is to follow: the goal
///   sum w |p - y|^2 / (2 sum w) + sum w_c (q - value)^2 / 2
/// of the seen markers and the coordinates. Tasks that are not applied are left out.
struct IkTasks {
  struct OfMarker {
    std::string name;
    double weight = 1;
  };

  std::vector<OfMarker> markers;
  std::vector<CoordinateTask> coordinates;
};

/// Of an `<IKTaskSet>`. What is wrong is added to the diagnostics.
IkTasks ReadIkTasks(const XmlElement& set, Diagnostics* diagnostics);

/// Parses an `<IKTaskSet>`, in an `<OpenSimDocument>` or in the set-up of a tool; file: named in
/// messages.
/// @throws Error where it is none, a number is none, or values are to come from a file.
IkTasks ParseIkTasks(std::string_view content, const std::string& file);

}  // namespace mmm_converter
