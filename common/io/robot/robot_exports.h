// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/io/robot/robot_motion.h"

namespace mmm_converter {

struct RobotExportOptions {
  std::optional<double> rate;       ///< [Hz]; nothing: the format's own, else the motion's
  std::optional<RobotOrder> order;  ///< of the formats that leave it open
  std::string motion_name = "motion";
};

/// A format of robot learning. A row of RobotExporters() is all there is to add: the option
/// --export-NAME, the attribute of batches, the checks of outputs and the help texts are made from
/// it.
struct RobotExporter {
  const char* name = "";    ///< "lafan1": attribute and folder of a batch
  const char* option = "";  ///< "export-lafan1"
  const char* ending = "";  ///< of its files
  const char* what = "";    ///< "joint angles as Unitree's CSV", for the help of a batch
  const char* help = "";    ///< of the option
  double rate = 0;          ///< [Hz] that its readers expect; 0: any
  /// There are readers of both orders, which no file tells: without one it is an error.
  bool needs_order = false;
  /// @throws Error; the file is then as it was before.
  void (*write)(const std::string& file, const Robot& robot, const PoseTrajectory& trajectory,
                const RobotExportOptions& options) = nullptr;
};

const std::vector<RobotExporter>& RobotExporters();

/// @throws Error with the names that there are where it is none of them.
const RobotExporter& FindRobotExporter(const std::string& name);

/// "isaac" (breadth first) or "mujoco" (depth first). @throws Error for another text.
RobotOrder ParseRobotOrder(const std::string& text);

}  // namespace mmm_converter
