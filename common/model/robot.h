// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/model/kinematic_model.h"

namespace mmm_converter {

/// A convex shape fixed to a segment with which a robot touches what is around it. Its axis is z
/// of G.
struct ContactShape {
  enum class Kind { kBox, kSphere, kCapsule, kCylinder, kEllipsoid, kHull };

  Kind kind = Kind::kSphere;
  int segment = 0;
  Eigen::Isometry3d X_SG = Eigen::Isometry3d::Identity();  ///< [m]
  Eigen::Vector3d half = Eigen::Vector3d::Zero();  ///< half sizes of a box or an ellipsoid [m]
  double radius = 0;                               ///< of a sphere, capsule or cylinder [m]
  double half_length = 0;  ///< of a capsule's or a cylinder's axis, a capsule's without caps [m]
  std::vector<Eigen::Vector3d> points = {};  ///< of a hull, its corners in G [m]
};

/// A mesh that a robot's file places on a segment.
struct RobotMesh {
  std::string file;  ///< as the robot's file calls it
  int segment = 0;
  Eigen::Affine3d A_SM = Eigen::Affine3d::Identity();  ///< from its own axes and unit [m]
  bool touches = true;                                 ///< not only looked at
  std::vector<Eigen::Vector3d> hull = {};              ///< corners in S [m]; none: not read
};

/// The point of the shape farthest in a direction, both in S: exact. Of several the middle one
/// where the direction is along the axis or a side.
Eigen::Vector3d SupportPoint(const ContactShape& shape, const Eigen::Vector3d& direction_S);

/// Of the shape's lowest point in W, its segment being at X_WS [m].
double LowestHeight(const ContactShape& shape, const Eigen::Isometry3d& X_WS);

/// A robot as its file has it (URDF, MJCF).
struct Robot {
  /// A body of the file (URDF: link), in its order, parents first. Several may be fixed to one
  /// segment, and a body with several joints is that of the last one's segment.
  struct Link {
    std::string name;
    int segment = 0;
    Eigen::Isometry3d X_SL = Eigen::Isometry3d::Identity();  ///< [m]
    int parent = -1;                                         ///< index of a link; -1: none
  };
  /// A place that the file names (MJCF: site).
  struct Site {
    std::string name;
    int segment = 0;
    Eigen::Isometry3d X_SP = Eigen::Isometry3d::Identity();  ///< [m]
  };

  KinematicModel model;  ///< segments have the names of their joints, the root that of its link
  std::vector<Link> links;
  std::vector<Site> sites;
  std::vector<ContactShape> shapes;  ///< those that touch, not those that are only looked at
  std::vector<RobotMesh> meshes;     ///< read where they are needed (io/robot/robot_meshes.h)
  Eigen::VectorXd velocity_limits;   ///< of joints [rad/s, sliding m/s]; infinity: not known
  std::string format;                ///< "URDF" or "MJCF"
  /// Segments that the file ties together, which nothing here does: loops.
  std::vector<std::array<int, 2>> ties = {};
  std::string file = {};               ///< that it was read of, from which meshes are named
  Eigen::VectorXd effort_limits = {};  ///< of joints' motors [N m, sliding N]; infinity: not known
};

/// The segment that the segment is fixed to without any moving joint between, nearest the root.
int RigidRoot(const KinematicModel& model, int segment);

/// What a user says of a robot's soles.
struct SoleChoice {
  enum class Take { kAny, kShapes, kMeshes };

  std::optional<double> depth = {};          ///< of the sole below the segment's origin [m]
  std::optional<Eigen::Vector2d> size = {};  ///< with depth: length and width [m]
  Take take = Take::kAny;                    ///< of a foot that has both: which; kAny: its shapes
};

/// Where a foot meets the ground, at the robot's zero pose (joints at rest, root upright).
struct Sole {
  enum class Source { kShapes, kMeshes, kNamed, kGiven };

  Source source = Source::kShapes;
  std::string said;        ///< "4 spheres of left_ankle_roll_link", "site left_sole"
  std::string doubt;       ///< why it may be another, in words; empty: nothing
  int segment = 0;         ///< RigidRoot of the foot
  double depth = 0;        ///< of the lowest point below the segment's origin [m]
  Eigen::Vector3d down_S;  ///< unit vector
  /// All of them in the axes of `segment`. Named or given: a sphere of no size at that place.
  std::vector<ContactShape> shapes;
};

/// The sole of the rigid body that the segment belongs to: what is given, else of that body and of
/// each below it its shapes, or those meshes that were read, touching ones before others; else a
/// site or link on it whose name has "sole" in it. Nothing: none of these; reason then says what
/// was found instead ("foot_link has 2 meshes, which are not read"). reason may be null.
std::optional<Sole> FindSole(const Robot& robot, int segment, const SoleChoice& choice,
                             std::string* reason);

}  // namespace mmm_converter
