// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/io/robot/robot_motion.h"

namespace mmm_converter {

/// Of an exported motion: above 0 and at most 1000 Hz.
inline bool IsExportRate(double rate) { return rate > 0 && rate <= 1000; }

struct RobotExportOptions {
  std::optional<double> rate;       ///< [Hz]; nothing: the format's own, else the motion's
  std::optional<RobotOrder> order;  ///< of the formats that leave it open
  std::string motion_name = "motion";
  std::vector<PoseTrajectory> objects = {};  ///< beside the robot, in the motion's frames
  std::vector<std::string> object_names = {};
};

/// A format of robot learning. A row of RobotExporters() is all there is to add: the option and
/// the checks of outputs are made from it.
struct RobotExporter {
  const char* name = "";    ///< "lafan1"
  const char* option = "";  ///< "export-lafan1"
  const char* ending = "";  ///< of its files in a batch
  const char* help = "";    ///< of the option
  /// There are readers of both orders, which no file tells: without one it is an error.
  bool needs_order = false;
  bool has_names = false;  ///< of joints and bodies beside it, in FILE.names.json
  /// @throws Error where the rate is none; the file is then as it was before.
  void (*write)(const std::string& file, const Robot& robot, const PoseTrajectory& trajectory,
                const RobotExportOptions& options) = nullptr;
  /// @throws Error where `write` would for the robot or the options. Null: it would not.
  void (*check)(const Robot& robot, const RobotExportOptions& options) = nullptr;
  double rate = 0;  ///< [Hz] that its readers expect; 0: the motion's
};

const std::vector<RobotExporter>& RobotExporters();

/// How FILE.names.json begins.
inline constexpr const char* kRobotNamesBegin = "{\n  \"rate\": ";

/// What writing `file` makes.
std::vector<std::string> FilesOf(const RobotExporter& exporter, const std::string& file);

/// @throws Error with the names that there are where it is none of them.
const RobotExporter& FindRobotExporter(const std::string& name);

/// "isaac" (breadth first) or "mujoco" (depth first). @throws Error for another text.
RobotOrder ParseRobotOrder(const std::string& text);

}  // namespace mmm_converter
