// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/math/scalar_function.h"
#include "common/support/index.h"

namespace mmm_converter {

class CoordinateMap;

enum class JointType {
  kFixed,
  kRevolute,
  kPrismatic,  ///< a length that no motion changes, as models of MMM have them
  kSliding,    ///< shifts along its axis
};

/// A model node (Simox: RobotNode): a rigid body and the joint that carries it.
/// Pose: X_WS = X_WP * X_PF * J(f(q)), P the parent segment, F the joint's fixed frame, q the
/// joint's coordinate ("joint angle"), J a turn about or a shift along the axis.
struct Segment {
  std::string name;
  int parent = -1;  ///< index of the parent segment; -1 for the floating root only
  Eigen::Isometry3d X_PF = Eigen::Isometry3d::Identity();  ///< [m]
  JointType type = JointType::kFixed;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit vector in F
  double lower = 0;  ///< of q [rad], sliding [m]; -infinity to infinity: without limits
  double upper = 0;  ///< of q [rad], sliding [m]
  int joint =
      -1;  ///< index into joint angles; -1: q is always 0 (fixed, prismatic, lower == upper)
  int leader = -1;  ///< index of the segment whose q moves this one too; -1: its own
  double mass = 0;  ///< [kg]
  Eigen::Vector3d p_SB = Eigen::Vector3d::Zero();       ///< centre of mass in S [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();    ///< about the CoM, in S axes [kg m^2]
  std::shared_ptr<const ScalarFunction> function = {};  ///< f [rad, m]; null: q itself
  double rest = 0;   ///< q where nothing moves the joint [rad, m]
  double reach = 0;  ///< of a joint without limits, how far it usually moves either way from its
                     ///< rest [rad, m]; 0: it turns without end
};

inline bool HasNoLimits(const Segment& segment) {
  return std::isinf(segment.lower) && std::isinf(segment.upper);
}

/// Turns as far as it likes.
inline bool IsEndless(const Segment& segment) {
  return segment.type == JointType::kRevolute && HasNoLimits(segment) && segment.reach == 0;
}

/// A virtual marker fixed to a segment (Simox: position sensor).
struct ModelMarker {
  std::string name;
  int segment = 0;
  Eigen::Vector3d p_SM = Eigen::Vector3d::Zero();  ///< [m]
  /// Of each coordinate of p_SM from where the person wears it, where that was estimated [m].
  std::optional<double> deviation = {};
  /// Of each coordinate about that place, from frame to frame [m]: soft tissue and noise.
  std::optional<double> skin_deviation = {};
};

/// What a model file contains, before it is made a KinematicModel.
struct ModelDescription {
  std::string name;
  std::vector<Segment> segments;  ///< any order; parents by index; `joint` is ignored
  std::vector<ModelMarker> markers;
  std::map<std::string, std::vector<std::string>> node_sets;
  /// The root does not float: its X_PF is X_WS, always.
  bool is_root_fixed = false;
  /// Null: root pose and joint angles are all that files know.
  std::shared_ptr<const CoordinateMap> coordinates = {};
  /// R_WS of a root that floats, where the body stands upright: of files whose z is not up.
  Eigen::Quaterniond standing = Eigen::Quaterniond::Identity();
};

/// Into KinematicModel::markers().
using MarkerIx = ListIndex<struct MarkerTag>;

/// Immutable tree of segments with a root that floats (6 DoF) or is fixed, joints and markers.
/// Segments are ordered so that a parent comes before its children; segment 0 is the root.
class KinematicModel {
 public:
  /// @throws Error where the segments are not one tree, names repeat, limits are crossed or a
  ///         number is not finite.
  explicit KinematicModel(ModelDescription description);

  const std::string& name() const { return name_; }
  const std::vector<Segment>& segments() const { return segments_; }
  const std::vector<ModelMarker>& markers() const { return markers_; }
  const std::map<std::string, std::vector<std::string>>& node_sets() const { return node_sets_; }

  bool is_root_fixed() const { return is_root_fixed_; }
  const std::shared_ptr<const CoordinateMap>& coordinates() const { return coordinates_; }
  const Eigen::Quaterniond& standing() const { return standing_; }  ///< ModelDescription::standing

  /// Joints are the revolute and sliding segments with lower < upper, in segment order, but for
  /// those that follow a leader, whose joint is theirs.
  int num_joints() const { return static_cast<int>(joint_segments_.size()); }
  const Segment& joint(int index) const { return segments_[joint_segments_[index]]; }
  int joint_segment(int index) const { return joint_segments_[index]; }

  int FindSegment(const std::string& name) const;  ///< -1 if there is none
  int FindJoint(const std::string& name) const;    ///< -1 if there is none
  int FindMarker(const std::string& name) const;   ///< -1 if there is none

  /// Whether a segment hangs on `above` by any joints, or is it.
  bool IsBelow(int segment, int above) const;

  double total_mass() const;  ///< [kg]

 private:
  std::string name_;
  std::vector<Segment> segments_;
  std::vector<ModelMarker> markers_;
  std::map<std::string, std::vector<std::string>> node_sets_;
  std::vector<int> joint_segments_;
  bool is_root_fixed_;
  std::shared_ptr<const CoordinateMap> coordinates_;
  Eigen::Quaterniond standing_;
};

/// What would make the same model again.
ModelDescription DescriptionOf(const KinematicModel& model);

/// f(q): what the segment's joint turns [rad] or shifts [m] by. It has a joint.
inline double JointValue(const Segment& segment, double q) {
  return segment.function ? segment.function->Value(q) : q;
}

/// J(f(q)). It has a joint.
Eigen::Isometry3d JointTransform(const Segment& segment, double q);

}  // namespace mmm_converter
