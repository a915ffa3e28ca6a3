// SPDX-License-Identifier: MIT
#include "common/io/urdf/urdf_robot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "common/io/urdf/urdf_model_reader.h"

namespace mmm_converter {
namespace {

class UrdfRobotBuilder {
 public:
  UrdfRobotBuilder(const UrdfDocument& document, UrdfModel model)
      : document_(document),
        segment_of_link_(std::move(model.segment_of_link)),
        robot_{std::move(model.model), {}, {}, {}, {}, {}, "URDF"} {}

  Robot Build();

 private:
  const UrdfLink& LinkAt(int link) const { return document_.links[static_cast<std::size_t>(link)]; }
  void PlaceLinks();
  void ListLinks();
  void SetLimits();

  const UrdfDocument& document_;
  const std::map<std::string, std::string> segment_of_link_;
  Robot robot_;
  std::vector<Robot::Link> places_;  // by link of the document
};

/// A link that is no segment, a marker, is fixed to that of its parent.
void UrdfRobotBuilder::PlaceLinks() {
  std::map<std::string, int> index_of;
  for (std::size_t i = 0; i < robot_.model.segments().size(); ++i) {
    index_of[robot_.model.segments()[i].name] = static_cast<int>(i);
  }
  for (const UrdfLink& link : document_.links) {
    Robot::Link& place = places_.emplace_back();
    place.name = link.name;
    const auto segment = segment_of_link_.find(link.name);
    if (segment != segment_of_link_.end()) {
      place.segment = index_of.at(segment->second);
      continue;
    }
    const UrdfJoint& joint = document_.joints[static_cast<std::size_t>(link.parent_joint)];
    place.segment = index_of.at(segment_of_link_.at(LinkAt(joint.parent).name));
    place.X_SL = joint.X_PF;
  }
}

/// Depth first, children in the order of the file, as segments are.
void UrdfRobotBuilder::ListLinks() {
  std::vector<std::vector<int>> children(places_.size());
  for (std::size_t i = places_.size(); i-- > 0;) {
    const int joint = document_.links[i].parent_joint;
    if (joint < 0) continue;
    const int parent = document_.joints[static_cast<std::size_t>(joint)].parent;
    children[static_cast<std::size_t>(parent)].push_back(static_cast<int>(i));
  }
  std::vector<std::pair<int, int>> open{{document_.root, -1}};  // link and its listed parent
  while (!open.empty()) {
    const auto [link, parent] = open.back();
    open.pop_back();
    robot_.links.push_back(places_[static_cast<std::size_t>(link)]);
    robot_.links.back().parent = parent;
    const int listed = static_cast<int>(robot_.links.size()) - 1;
    for (const int child : children[static_cast<std::size_t>(link)]) {
      open.emplace_back(child, listed);
    }
  }
}

/// What follows another joint has no motor.
void UrdfRobotBuilder::SetLimits() {
  robot_.velocity_limits.setConstant(robot_.model.num_joints(),
                                     std::numeric_limits<double>::infinity());
  robot_.effort_limits = robot_.velocity_limits;
  std::map<std::string, const UrdfJoint*> joints;
  for (const UrdfJoint& joint : document_.joints) joints[joint.name] = &joint;
  for (const Segment& segment : robot_.model.segments()) {
    if (segment.joint < 0) continue;
    const UrdfJoint& joint = *joints.at(segment.name);
    if (segment.leader < 0 && joint.effort > 0) robot_.effort_limits[segment.joint] = joint.effort;
    double slope = 1;
    if (segment.function) segment.function->Value(0, &slope);
    const double velocity = joint.velocity;
    if (velocity <= 0 || slope == 0) continue;
    double& limit = robot_.velocity_limits[segment.joint];
    limit = std::min(limit, velocity / std::abs(slope));
  }
}

Robot UrdfRobotBuilder::Build() {
  PlaceLinks();
  ListLinks();
  SetLimits();
  for (ContactShape shape : document_.shapes) {
    const Robot::Link& place = places_[static_cast<std::size_t>(shape.segment)];
    shape.segment = place.segment;
    shape.X_SG = place.X_SL * shape.X_SG;
    robot_.shapes.push_back(shape);
  }
  for (RobotMesh mesh : document_.meshes) {
    const Robot::Link& place = places_[static_cast<std::size_t>(mesh.segment)];
    mesh.segment = place.segment;
    mesh.A_SM = place.X_SL * mesh.A_SM;
    robot_.meshes.push_back(std::move(mesh));
  }
  return std::move(robot_);
}

}  // namespace

Robot ParseUrdfRobot(std::string_view content, const std::string& file, Warnings* warnings) {
  Diagnostics diagnostics(file, warnings);
  const UrdfDocument document = ParseUrdf(content, &diagnostics);
  Robot robot = UrdfRobotBuilder(document, MakeUrdfModel(document, &diagnostics)).Build();
  robot.file = file;
  return robot;
}

}  // namespace mmm_converter
