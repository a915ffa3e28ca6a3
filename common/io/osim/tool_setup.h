// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "common/support/warnings.h"

namespace mmm_converter {

/// What the set-up of one of OpenSim's tools says of a recording: `<InverseKinematicsTool>`,
/// `<ScaleTool>` or `<InverseDynamicsTool>`. Files are as it names them; empty: it names none.
struct OsimToolSetup {
  std::string tool;  ///< "InverseKinematicsTool"
  std::string model_file;
  std::string marker_set_file;   ///< of a MarkerSet for the model
  std::string marker_file;       ///< the recording; of a ScaleTool the standing one
  std::string coordinates_file;  ///< the motion
  std::string loads_file;        ///< ExternalLoads
  bool has_tasks = false;        ///< an IKTaskSet, with what markers weigh, in the set-up itself
  std::string tasks_file;        ///< or in a file of its own
  std::optional<std::array<double, 2>> time_range;  ///< [s]; nothing: all
};

/// Whether the content is a set-up of one of these tools.
bool IsOsimToolSetup(std::string_view content);

/// @throws Error where it is none, or its time range is none.
OsimToolSetup ParseOsimToolSetup(std::string_view content, const std::string& file);

/// A file that a set-up names, as OpenSim finds it: beside the set-up, or by the path from there.
/// Backslashes separate folders, too. What was written on another machine is looked for beside the
/// set-up by its name alone, which is told.
/// @throws Error where there is no such file; what: "model".
std::string FindFileOfSetup(const std::string& setup_file, const std::string& named,
                            const char* what, Warnings* warnings);

}  // namespace mmm_converter
