// SPDX-License-Identifier: MIT
#include "common/pipeline/robot.h"

#include <utility>

#include "common/io/robot_file.h"
#include "common/retarget/body_map.h"

namespace mmm_converter {

LoadedRobot ReadRobot(const RobotRequest& request, Warnings* warnings) {
  Robot robot = ReadRobotFile(request.file, warnings);
  BodyMapChoice map;
  if (!request.map_file.empty()) map = ReadBodyMapChoice(request.map_file);
  RobotBody body = FindRobotBody(robot, map, request.sole_height);
  return {std::move(robot), std::move(body)};
}

}  // namespace mmm_converter
