// SPDX-License-Identifier: MIT
#include "common/pipeline/robot.h"

#include <fmt/format.h>

#include <utility>

#include "common/io/robot_file.h"
#include "common/retarget/body_map.h"
#include "common/retarget/held_joints.h"
#include "common/support/advice.h"
#include "common/support/error.h"

namespace mmm_converter {

namespace {

BodyMapChoice MapChoiceOf(const RobotRequest& request) {
  return request.map_file.empty() ? BodyMapChoice{} : ReadBodyMapChoice(request.map_file);
}

/// Upright, too, if its file's z is not up.
Robot ReadStandingRobot(const std::string& file, Warnings* warnings) {
  Robot robot = ReadRobotFile(file, warnings);
  ModelDescription standing = DescriptionOf(robot.model);
  standing.standing = FindStanding(robot.model);
  robot.model = KinematicModel(std::move(standing));
  return robot;
}

}  // namespace

LoadedRobot ReadRobot(const RobotRequest& request, Warnings* warnings) {
  Robot robot = ReadStandingRobot(request.file, warnings);
  RobotBody body = FindRobotBody(robot, MapChoiceOf(request), request.sole_height);
  if (!request.objects.empty() && !body.feet) {
    throw Error(fmt::format("{}: {} needs a robot with legs, and this one has none", request.file,
                            OptionText("objects")));
  }
  HoldJoints(robot, request.hold, &body);
  return {std::move(robot), std::move(body)};
}

std::string DescribeRobotMap(const RobotRequest& request, Warnings* warnings) {
  const Robot robot = ReadStandingRobot(request.file, warnings);
  const BodyMap map = FindRobotMap(robot, MapChoiceOf(request));
  std::string text = FormatBodyMap(robot.model, map);
  for (const Side side : kSides) {
    if (!map.leg(side)) continue;
    std::string reason;
    const auto sole = FindSole(robot, map.leg(side)->end, request.sole_height, &reason);
    text += fmt::format("{} sole: {}\n", Name(side),
                        sole ? sole->said
                             : fmt::format("not known ({}); {} gives its height below {}", reason,
                                           OptionText("sole-height"),
                                           robot.model.segments()[map.leg(side)->end].name));
  }
  return text;
}

}  // namespace mmm_converter
