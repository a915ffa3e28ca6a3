// SPDX-License-Identifier: MIT
#include "common/io/robot/robot_meshes.h"

#include <fmt/format.h>

#include <map>
#include <numbers>
#include <string>

#include "common/io/mesh/extreme_points.h"
#include "common/io/mesh/mesh_file.h"
#include "common/io/mesh/mesh_paths.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

constexpr double kLeastSize = 0.005, kMostReach = 3;  // [m] of a part of a robot, from its joint
constexpr const char* kKind = "meshes that can't be read";

std::string LinkOf(const Robot& robot, const RobotMesh& mesh) {
  for (const Robot::Link& link : robot.links) {
    if (link.segment == mesh.segment && !link.name.empty()) return link.name;
  }
  return robot.model.segments()[static_cast<std::size_t>(mesh.segment)].name;
}

Eigen::Vector3d MiddleOf(const Eigen::Matrix3Xd& points) {
  return 0.5 * (points.rowwise().minCoeff() + points.rowwise().maxCoeff());
}

/// In S. Files of robots are often made for viewers that do not look at a mesh's up axis: where the
/// link's centre of mass is nearer to the mesh as it is, it is taken so.
Eigen::Matrix3Xd PlacedPoints(const MeshPoints& read, const RobotMesh& mesh,
                              const Segment& segment) {
  Eigen::Matrix3Xd as_it_is = mesh.A_SM * read.points;
  if (!read.is_y_up) return as_it_is;
  const Eigen::AngleAxisd upright(std::numbers::pi / 2, Eigen::Vector3d::UnitX());
  Eigen::Matrix3Xd turned = mesh.A_SM * (upright.toRotationMatrix() * read.points);
  const bool fits_as_it_is = segment.mass > 0 && (MiddleOf(as_it_is) - segment.p_SB).norm() <
                                                     (MiddleOf(turned) - segment.p_SB).norm();
  return fits_as_it_is ? as_it_is : turned;
}

class MeshReader {
 public:
  MeshReader(Robot* robot, Warnings* warnings) : robot_(*robot), warnings_(warnings) {}

  void ReadBody(int body) {
    for (const bool touches : {true, false}) {
      bool is_known = false;
      for (RobotMesh& mesh : robot_.meshes) {
        if (mesh.touches != touches || RigidRoot(robot_.model, mesh.segment) != body) continue;
        if (mesh.hull.empty()) Read(&mesh);
        is_known = is_known || !mesh.hull.empty();
      }
      if (is_known) return;
    }
  }

 private:
  void WarnOf(const RobotMesh& mesh, const std::string& text) {
    WarnOfKind(warnings_, kKind,
               fmt::format("{}: the mesh {} of {} {}", robot_.file, mesh.file, LinkOf(robot_, mesh),
                           text));
  }

  const MeshPoints* PointsOf(const RobotMesh& mesh) {
    if (IsFarAway(mesh.file)) {
      WarnOf(mesh, "is an address, which is not fetched; keep a copy beside the robot's file");
      return nullptr;
    }
    const auto found = FindMeshFile(mesh.file, robot_.file);
    if (!found) {
      WarnOf(mesh,
             "is not there; put it where the file says, or name its package's folder in "
             "ROS_PACKAGE_PATH");
      return nullptr;
    }
    const auto [known, is_new] = read_.try_emplace(found->path);
    if (!is_new) return &known->second;
    if (found->is_elsewhere) WarnOf(mesh, fmt::format("is taken from {}", found->path));
    known->second = ReadMesh(found->path);
    return &known->second;
  }

  void Read(RobotMesh* mesh) {
    try {
      const MeshPoints* read = PointsOf(*mesh);
      if (read == nullptr || read->points.cols() == 0) return;
      const auto& segment = robot_.model.segments()[static_cast<std::size_t>(mesh->segment)];
      const Eigen::Matrix3Xd points = PlacedPoints(*read, *mesh, segment);
      const double reach = points.cwiseAbs().maxCoeff();
      const double size = (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).maxCoeff();
      if (!(reach <= kMostReach && size >= kLeastSize)) {
        WarnOf(*mesh,
               fmt::format("reaches {:.3g} m from its joint and is {:.3g} m large, as no part "
                           "of a robot; a scale in the robot's file brings it to metres",
                           reach, size));
        return;
      }
      mesh->hull = ExtremePoints(points);
    } catch (const Error& error) {
      WarnOf(*mesh, fmt::format("can't be read: {}", error.what()));
    }
  }

  Robot& robot_;
  Warnings* warnings_;
  std::map<std::string, MeshPoints> read_;
};

}  // namespace

void ReadMeshes(int segment, Robot* robot, Warnings* warnings) {
  MeshReader reader(robot, warnings);
  const int root = RigidRoot(robot->model, segment);
  for (int body = root; body < static_cast<int>(robot->model.segments().size()); ++body) {
    if (!robot->model.IsBelow(body, root)) continue;
    if (RigidRoot(robot->model, body) == body) reader.ReadBody(body);
  }
}

}  // namespace mmm_converter
