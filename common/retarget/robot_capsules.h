// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <utility>
#include <vector>

#include "common/model/robot.h"
#include "common/retarget/body_map.h"

namespace mmm_converter {

enum class BodyPart { kTrunk, kLeftLeg, kRightLeg, kLeftArm, kRightArm };

/// All points within `radius` of a line, fixed to a segment.
struct BodyCapsule {
  Eigen::Vector3d a_S, b_S;  ///< ends of the line [m]
  double radius = 0;         ///< [m]
};

/// A rigid body of a robot and its capsules.
struct CapsuleBody {
  std::string name;  ///< of its link
  int segment = 0;   ///< RigidRoot
  BodyPart part = BodyPart::kTrunk;
  bool is_by_mass = false;
  std::vector<BodyCapsule> capsules;
  Eigen::Vector3d centre_S = Eigen::Vector3d::Zero();  ///< of a ball around all of them [m]
  double reach = 0;                                    ///< its radius [m]
};

/// What a robot touches itself with. Capsules are within a body's boxes, cylinders and ellipsoids,
/// but for these' edges. A body without shapes, of meshes, gets those of the box of even density
/// that has its mass and inertia.
struct RobotCapsules {
  std::vector<CapsuleBody> bodies;
  /// Indices of bodies of different parts that are watched: they are not joined closely and do not
  /// touch at the zero pose or where the robot stands with hanging arms.
  std::vector<std::pair<int, int>> pairs;
  std::vector<std::string> unknown;  ///< links of limbs of whose size nothing is known
};

/// Without pairs.
RobotCapsules FindCapsules(const Robot& robot, const BodyMap& map);

/// All pairs that are not joined closely.
void PairBodies(const KinematicModel& model, const BodyMap& map, RobotCapsules* capsules);

/// Where capsules are, W [m]; its vectors are sized by the first PlaceCapsules.
struct PlacedCapsules {
  struct Line {
    Eigen::Vector3d a, b;
    double radius = 0;
  };
  std::vector<Line> lines;               ///< of all bodies, one after the other
  std::vector<int> begins;               ///< of each body's, and the end
  std::vector<Eigen::Vector3d> centres;  ///< of bodies
};
void PlaceCapsules(const RobotCapsules& capsules, const std::vector<Eigen::Isometry3d>& X_WS,
                   PlacedCapsules* placed);

/// How two bodies are to each other.
struct Touch {
  double depth = 0;                   ///< that one goes into the other [m]; < 0: apart
  Eigen::Vector3d p_first, p_second;  ///< nearest places of their lines, W [m]
};

/// The deepest of all of their capsules. Bodies that are farther apart than `near` [m]: a depth of
/// -infinity and no places.
Touch FindTouch(const RobotCapsules& capsules, const PlacedCapsules& placed,
                const std::pair<int, int>& pair, double near);

}  // namespace mmm_converter
