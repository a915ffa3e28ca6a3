// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "common/model/kinematic_model.h"

namespace mmm_converter {

/// A robot as it stands at its zero pose, and what of it moves.
struct ZeroPose {
  explicit ZeroPose(const KinematicModel& model);

  const KinematicModel* model;
  Eigen::VectorXd angles;  ///< of all joints
  std::vector<Eigen::Isometry3d> X_WS;
  std::vector<int> moving_parent;  ///< of each segment, the next one above that moves; -1: none
  std::vector<Eigen::Vector3d> mass_centre;  ///< of its rigid body, W; its origin if it has no mass
  double size = 0;                           ///< of a box around all origins, its diagonal [m]

  bool Moves(int segment) const { return model->segments()[segment].joint >= 0; }
  Eigen::Vector3d origin(int segment) const { return X_WS[segment].translation(); }
  /// Of a segment that moves: its joint's axis, W.
  Eigen::Vector3d axis(int segment) const;
  /// How far a segment that moves turns about its axis until its joint is at q [rad].
  double Turn(int segment, double q) const;
};

/// Two chains of moving segments that are images of each other in a vertical plane, from the first
/// that is not common to both to the last before fingers or the end.
struct MirroredPair {
  std::array<std::vector<int>, 2> chains;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< of the plane, from chain 1 to chain 0, W
  /// How far the joint that folds most brings the ends nearer to the centre before it [m].
  double most_folding = 0;
  double reach = 0;   ///< from the centre about which that joint folds them to the ends [m]
  double lowest = 0;  ///< height of the ends [m]
};

/// The place on two lines p + t a where they are nearest, share 0 on the first and 1 on the second.
Eigen::Vector3d NearestPoint(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                             const Eigen::Vector3d& q, const Eigen::Vector3d& b, double share);

/// About which the joints of the chain before that one turn it, W: where the last two axes that are
/// not parallel come nearest. Where origins lie along their axes tells nothing.
Eigen::Vector3d CentreBefore(const ZeroPose& zero, const std::vector<int>& chain, int joint);

/// The last of the chain's joints that are one knee or elbow with that one: the same joint turns
/// them all, the same way about parallel axes, and they are nearer to it than to the chain's end.
int LastOfFold(const ZeroPose& zero, const std::vector<int>& chain, int joint);

/// Where p, at the chain's end, is when the joints of that fold are at q, W.
Eigen::Vector3d Folded(const ZeroPose& zero, const std::vector<int>& chain, int joint, double q,
                       Eigen::Vector3d p);

/// What bends a chain: by how much the distance of its end from CentreBefore changes while each
/// joint (LastOfFold) goes through its limits [m], the others standing at zero; a row a joint.
struct FoldSweep {
  Eigen::VectorXd change;
  Eigen::VectorXd straight;  ///< where the distance is largest [rad]
  Eigen::VectorXd longest;   ///< that distance [m]
};
FoldSweep SweepChain(const ZeroPose& zero, const std::vector<int>& chain);

/// All pairs of at least three joints each. @throws Error where the model has too many joints.
std::vector<MirroredPair> FindMirroredPairs(const ZeroPose& zero);

/// +1: the first is on the left and the second on the right by their names ("left_knee",
/// "R_Elbow", "l1"), which differ in that and in numbers alone; -1: the other way; 0: they do not
/// tell.
int SideByNames(const std::string& first, const std::string& second);

}  // namespace mmm_converter
