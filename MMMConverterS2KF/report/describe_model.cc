// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "MMMConverterS2KF/report/describe.h"
#include "common/io/mjcf/mjcf_robot.h"
#include "common/io/model_file.h"
#include "common/io/robot/robot_file.h"
#include "common/io/robot/robot_meshes.h"
#include "common/io/urdf/urdf_model_reader.h"
#include "common/model/forward_kinematics.h"

namespace mmm_converter {
namespace {

constexpr double kFootHeight = 0.1;  // [m]; feet are as low as the lowest end, but for this

std::string Range(const Segment& joint) {
  if (HasNoLimits(joint)) return "without limits";
  return fmt::format("{:9.6f} to {:9.6f} {}", joint.lower, joint.upper,
                     joint.type == JointType::kSliding ? "m" : "rad");
}

void DescribeJoints(const KinematicModel& model, const Robot* robot, std::string* text,
                    Json* json) {
  for (int j = 0; j < model.num_joints(); ++j) {
    const Segment& joint = model.joint(j);
    const bool slides = joint.type == JointType::kSliding;
    *text += fmt::format("  {:<24} {}", joint.name, Range(joint));
    Json one = {{"name", joint.name},
                {slides ? "lower_m" : "lower_rad", joint.lower},
                {slides ? "upper_m" : "upper_rad", joint.upper}};
    if (robot != nullptr && std::isfinite(robot->velocity_limits[j])) {
      const double velocity = robot->velocity_limits[j];
      *text += fmt::format(", up to {:.6g} {}/s", velocity, slides ? "m" : "rad");
      one[slides ? "velocity_m_per_s" : "velocity_rad_per_s"] = velocity;
    }
    *text += '\n';
    (*json)["joints"].push_back(std::move(one));
  }
}

void DescribeMarkers(const KinematicModel& model, std::string* text, Json* json) {
  *text += fmt::format("markers    {}\n", model.markers().size());
  for (const ModelMarker& marker : model.markers()) {
    const std::string& segment = model.segments()[marker.segment].name;
    const Eigen::Vector3d& p = marker.p_SM;
    *text += fmt::format("  {:<14} on {:<24} at {:7.4f} {:7.4f} {:7.4f} m\n", marker.name, segment,
                         p.x(), p.y(), p.z());
    (*json)["markers"].push_back(
        {{"name", marker.name}, {"segment", segment}, {"offset_m", {p.x(), p.y(), p.z()}}});
  }
}

/// The moving segments that carry no other, and are lowest where all joints rest.
std::vector<int> LowestEnds(const KinematicModel& model) {
  const int count = static_cast<int>(model.segments().size());
  std::vector<bool> is_end(model.segments().size(), true);
  for (int i = 0; i < count; ++i) {
    const Segment& segment = model.segments()[i];
    if (segment.joint >= 0) is_end[RigidRoot(model, segment.parent)] = false;
  }
  Posture posture = ZeroPosture(model);
  if (!model.is_root_fixed()) posture.joint_angles = RestAngles(model);
  const auto X_WS = SegmentPoses(model, posture);
  std::vector<int> ends;
  double lowest = 0;
  for (int i = 0; i < count; ++i) {
    if (model.segments()[i].joint < 0 || !is_end[i]) continue;
    lowest = ends.empty() ? X_WS[i].translation().z() : std::min(lowest, X_WS[i].translation().z());
    ends.push_back(i);
  }
  std::erase_if(ends, [&](int i) { return X_WS[i].translation().z() > lowest + kFootHeight; });
  return ends;
}

void DescribeRobotParts(const Robot& robot, std::string* text, Json* json) {
  *text += fmt::format("bodies     {}\nshapes     {}, meshes {} (those of feet are read)\n",
                       robot.links.size(), robot.shapes.size(), robot.meshes.size());
  (*json)["format"] = robot.format;
  (*json)["bodies"] = Json::array();
  for (const Robot::Link& link : robot.links) (*json)["bodies"].push_back(link.name);
  (*json)["shapes"] = robot.shapes.size();
  (*json)["meshes"] = robot.meshes.size();
  (*json)["soles"] = Json::array();
  for (const int end : LowestEnds(robot.model)) {
    const std::string& name = robot.model.segments()[end].name;
    std::string reason;
    const std::optional<Sole> sole = FindSole(robot, end, {}, &reason);
    const std::string said =
        sole ? fmt::format("{:.1f} mm below, {}", 1e3 * sole->depth, sole->said) : reason;
    *text += fmt::format("sole       {}: {}\n", name, said);
    (*json)["soles"].push_back({{"joint", name},
                                {"depth_m", sole ? Json(sole->depth) : Json(nullptr)},
                                {"source", sole ? sole->said : reason}});
  }
}

}  // namespace

Description DescribeModel(const FileStart& file, const ReadRecordingOptions&) {
  Warnings warnings;
  std::optional<Robot> robot;
  if (IsUrdf(file.head) || IsMjcf(file.head)) robot = ReadRobotFile(file.path, &warnings);
  if (robot) {
    for (const int end : LowestEnds(robot->model)) {
      const bool has_sole = FindSole(*robot, end, {}, nullptr).has_value();
      ReadMeshes(end, &*robot, has_sole ? nullptr : &warnings);
    }
  }
  const KinematicModel model = robot ? robot->model : ReadModelFile(file.path, &warnings).model;
  std::string text = fmt::format(
      "{}: model {}\nsegments   {}\nmass       {:.6g} kg\nnode sets  {}\njoints     {}\n",
      file.path, model.name(), model.segments().size(), model.total_mass(),
      model.node_sets().size(), model.num_joints());
  Json json = {{"kind", "model"},
               {"file", file.path},
               {"name", model.name()},
               {"segments", model.segments().size()},
               {"mass_kg", model.total_mass()},
               {"joints", Json::array()},
               {"markers", Json::array()},
               {"node_sets", Json::array()},
               {"warnings", warnings.texts()}};
  DescribeJoints(model, robot ? &*robot : nullptr, &text, &json);
  DescribeMarkers(model, &text, &json);
  if (robot) DescribeRobotParts(*robot, &text, &json);
  for (const auto& [name, unused] : model.node_sets()) json["node_sets"].push_back(name);
  return {text, FormatJson(json), warnings};
}

}  // namespace mmm_converter
