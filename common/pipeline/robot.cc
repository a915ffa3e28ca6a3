// SPDX-License-Identifier: MIT
#include "common/pipeline/robot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

#include "common/io/bytes/file_content.h"
#include "common/io/robot/robot_file.h"
#include "common/io/robot/robot_meshes.h"
#include "common/model/forward_kinematics.h"
#include "common/retarget/body_map.h"
#include "common/retarget/held_joints.h"
#include "common/support/advice.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {

namespace {

constexpr double kSameRoot = 1e-3;  // [m]

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

[[noreturn]] void ThrowSole(const std::string& text) {
  throw Error(
      fmt::format("{}: \"{}\" is neither LENGTH,WIDTH,HEIGHT in metres, as 0.22,0.08,0.05, nor "
                  "meshes or shapes",
                  OptionText("sole"), text));
}

SoleChoice SoleChoiceOf(const RobotRequest& request) {
  SoleChoice choice;
  choice.depth = request.sole_height;
  if (request.sole.empty()) return choice;
  if (request.sole_height) {
    throw Error(
        fmt::format("{} and {}: give one of them", OptionText("sole"), OptionText("sole-height")));
  }
  if (request.sole == "meshes" || request.sole == "shapes") {
    choice.take = request.sole == "meshes" ? SoleChoice::Take::kMeshes : SoleChoice::Take::kShapes;
    return choice;
  }
  const std::vector<std::string> parts = Split(request.sole, ',');
  if (parts.size() != 3) ThrowSole(request.sole);
  Eigen::Vector3d sizes;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto number = ParseDouble(parts[i]);
    if (!number || !std::isfinite(*number)) ThrowSole(request.sole);
    sizes[static_cast<Eigen::Index>(i)] = *number;
  }
  choice.size = sizes.head<2>();
  choice.depth = sizes.z();
  return choice;
}

/// Where shapes tell what a sole is, meshes that are not there are no loss.
void ReadFeet(const BodyMap& map, const SoleChoice& choice, Robot* robot, Warnings* warnings) {
  if (choice.depth || choice.take == SoleChoice::Take::kShapes) return;
  SoleChoice of_shapes;
  of_shapes.take = SoleChoice::Take::kShapes;
  for (const Side side : kSides) {
    if (!map.leg(side)) continue;
    const int end = map.leg(side)->end;
    const bool are_needed =
        choice.take == SoleChoice::Take::kMeshes || !FindSole(*robot, end, of_shapes, nullptr);
    ReadMeshes(end, robot, are_needed ? warnings : nullptr);
  }
}

/// An Error ends with what was noticed of meshes, which may be why the soles are not known.
RobotBody FindBody(const Robot& robot, const BodyMapChoice& map, const SoleChoice& sole,
                   const Warnings& of_meshes) {
  try {
    return FindRobotBody(robot, map, sole);
  } catch (const Error& error) {
    std::string message = error.what();
    for (const std::string& text : of_meshes.texts()) message += "\n" + text;
    throw Error(message, error.remedy());
  }
}

/// Learning tools take the root for the body that floats.
void WarnOfBareRoot(const Robot& robot, Warnings* warnings) {
  const KinematicModel& model = robot.model;
  int body = 0;  // the first with mass that is fixed to the root
  while (body < static_cast<int>(model.segments().size()) &&
         (model.segments()[body].mass == 0 || RigidRoot(model, body) != 0)) {
    ++body;
  }
  if (model.is_root_fixed() || body == 0 || body == static_cast<int>(model.segments().size())) {
    return;
  }
  const auto X_WS = SegmentPoses(model, ZeroPosture(model));
  const double way = (X_WS[body].translation() - X_WS[0].translation()).norm();
  const auto link = std::find_if(robot.links.begin(), robot.links.end(),
                                 [&](const Robot::Link& one) { return one.segment == body; });
  if (way < kSameRoot || link == robot.links.end()) return;
  Warn(warnings, fmt::format("the root of the robot is the link {}, which has no mass, {:.3f} m "
                             "from {}: all files hold where {} is; where {} is to float, take the "
                             "joint {} out of the robot's file",
                             robot.links.front().name, way, link->name, robot.links.front().name,
                             link->name, model.segments()[body].name));
}

/// Of the option's text, or of the file that it names.
AimWeights ReadWeights(const std::string& text) {
  constexpr std::size_t kMostBytes = 1 << 16;
  std::error_code failure;
  if (!std::filesystem::is_regular_file(text, failure)) return ParseAimWeights(text);
  return ParseAimWeightLines(ReadFileContent(text, kMostBytes), text);
}

}  // namespace

LoadedRobot ReadRobot(const RobotRequest& request, Warnings* warnings) {
  Robot robot = ReadStandingRobot(request.file, warnings);
  const SoleChoice sole = SoleChoiceOf(request);
  const BodyMapChoice map = MapChoiceOf(request);
  const AimWeights weights = ReadWeights(request.weights);
  Warnings of_meshes;
  ReadFeet(FindRobotMap(robot, map), sole, &robot, &of_meshes);
  RobotBody body = FindBody(robot, map, sole, of_meshes);
  if (warnings != nullptr) warnings->Append(of_meshes);
  if (!request.objects.empty() && !body.feet) {
    throw Error(fmt::format("{}: {} needs a robot with legs, and this one has none", request.file,
                            OptionText("objects")));
  }
  HoldJoints(robot, request.hold, &body);
  if (!request.hold.empty() && BendFeet(body, &robot.model)) {
    body = FindBody(robot, map, sole, of_meshes);
    HoldJoints(robot, request.hold, &body);
  }
  body.weights = weights;
  if (const std::string doubt = DoubtOf(robot, body); !doubt.empty()) Warn(warnings, doubt);
  WarnOfBareRoot(robot, warnings);
  if (!body.map.left_out.empty()) {
    Warn(warnings, fmt::format("{} are of no two limbs that are images of each other: they stay at "
                               "rest",
                               FirstNames(body.map.left_out)));
  }
  return {std::move(robot), std::move(body)};
}

std::string DescribeRobotMap(const RobotRequest& request, Warnings* warnings) {
  const SoleChoice choice = SoleChoiceOf(request);
  Robot robot = ReadStandingRobot(request.file, warnings);
  const BodyMap map = FindRobotMap(robot, MapChoiceOf(request));
  ReadFeet(map, choice, &robot, warnings);
  std::string text = FormatBodyMap(robot.model, map);
  for (const Side side : kSides) {
    if (!map.leg(side)) continue;
    std::string reason;
    const auto sole = FindSole(robot, map.leg(side)->end, choice, &reason);
    text += fmt::format("{} sole: {}\n", Name(side),
                        sole ? sole->said
                             : fmt::format("not known ({}); {} gives its size and its depth below "
                                           "{}",
                                           reason, OptionText("sole"),
                                           robot.model.segments()[map.leg(side)->end].name));
  }
  return text;
}

}  // namespace mmm_converter
