// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/model/kinematic_model.h"
#include "common/motion/foot_motion.h"

namespace mmm_converter {

/// A place fixed to a segment.
struct BodyPoint {
  int segment = -1;
  Eigen::Vector3d p_S = Eigen::Vector3d::Zero();  ///< [m]
};

/// Half of a limb between two centres, fixed to a segment. Its axes, as columns: z towards the
/// proximal centre, y along the fold axis to the left of a limb that hangs, x = y x z forward.
struct LimbSegment {
  int segment = -1;
  Eigen::Matrix3d R_SL = Eigen::Matrix3d::Identity();
  double length = 0;  ///< between the centres, across the fold axis [m]
};

/// An arm or a leg.
struct LimbMap {
  std::vector<int> chain;              ///< its segments that move, the first one first
  int fold = 0;                        ///< of chain: the knee or the elbow
  int beyond = 1;                      ///< the first that is not: several that turn as one may be
  int end = -1;                        ///< of chain.back(): the foot or the hand
  BodyPoint proximal, middle, distal;  ///< hip, knee, ankle; shoulder, elbow, wrist
  LimbSegment upper, lower;            ///< thigh and shank; upper arm and forearm
  double between = 0;                  ///< from the fold's first joint to its last [m]
  Eigen::Matrix3d R_ED = Eigen::Matrix3d::Identity();  ///< axes of `end` that are `lower`'s at zero
  bool has_wrist = false;  ///< joints beyond the fold turn the end otherwise than the forearm

  double length() const { return upper.length + between + lower.length; }  ///< [m]
};

/// Which of a body's segments are which part of a person.
struct BodyMap {
  std::array<std::optional<LimbMap>, 2> legs, arms;  ///< left, right
  int pelvis = 0, chest = 0;
  /// Columns: forward, left and up where the body stands at its zero pose, W.
  Eigen::Matrix3d R_WA = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d R_PA = Eigen::Matrix3d::Identity();  ///< the same in the pelvis
  Eigen::Matrix3d R_CA = Eigen::Matrix3d::Identity();  ///< in the chest
  std::vector<std::string> evidence;                   ///< why, in words
  std::vector<std::string> left_out;  ///< joints named as of a limb that was not found in a pair

  const std::optional<LimbMap>& leg(Side side) const {
    return legs[static_cast<std::size_t>(side)];
  }
  const std::optional<LimbMap>& arm(Side side) const {
    return arms[static_cast<std::size_t>(side)];
  }
  bool has_legs() const { return legs[0].has_value() && legs[1].has_value(); }
  bool has_arms() const { return arms[0].has_value() && arms[1].has_value(); }
};

/// What a user says of a limb; joints by the segments' names.
struct LimbChoice {
  std::string first, fold, last;
};

/// Said instead of found. Where limbs are said, those that are not are not looked for.
struct BodyMapChoice {
  std::array<std::optional<LimbChoice>, 2> legs, arms;  ///< left, right
  std::optional<Eigen::Vector3d> forward;               ///< at the zero pose, W
};

/// From the structure alone: the mirrored pair of chains that ends lowest are the legs of a robot
/// that is not fixed, of the others the pair that folds most are the arms; the joint that folds a
/// chain most is its knee or elbow, and as knees go back and elbows to the front, that tells where
/// forward and left are. Names of joints have to agree; where the structure does not tell, they
/// decide.
/// @throws Error naming the joints where two readings fit alike, or evidence contradicts itself.
BodyMap FindBodyMap(const KinematicModel& model, const BodyMapChoice& choice);

/// How its root is turned where the body stands on its legs: as the model says, or if its legs do
/// not hang down then, by the one axis along which they do.
Eigen::Quaterniond FindStanding(const KinematicModel& model);

/// `<BodyMap forward="1 0 0"><Limb name="left leg" first="" fold="" last=""/>...</BodyMap>`; each
/// limb and forward may be left out. @throws Error with all problems of the file.
BodyMapChoice ReadBodyMapChoice(const std::string& file);

/// As text for people, a limb a line.
std::string FormatBodyMap(const KinematicModel& model, const BodyMap& map);

/// "left leg"
std::string LimbName(bool is_leg, Side side);

}  // namespace mmm_converter
