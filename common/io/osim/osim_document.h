// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "common/math/scalar_function.h"
#include "common/support/diagnostics.h"

namespace mmm_converter {

inline constexpr std::size_t kMaxOsimBytes = std::size_t{64} << 20;  ///< real ones have up to 8 MB
inline constexpr std::size_t kMaxOsimBodies = 2048;                  ///< and up to some 80 bodies

/// A body, `ground` being the first of a document.
struct OsimBody {
  std::string name;
  int line = 0;
  double mass = 0;                                    ///< [kg]
  Eigen::Vector3d p_BC = Eigen::Vector3d::Zero();     ///< centre of mass in the body's frame [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about it, in axes of the body [kg m^2]
};

/// What a file in degrees says of a coordinate: turns in degrees, all else in radians or metres.
enum class OsimMotionType { kRotational, kTranslational, kCoupled };

struct OsimCoordinate {
  std::string name;
  int line = 0;
  OsimMotionType motion_type = OsimMotionType::kCoupled;
  double default_value = 0;  ///< [rad] or [m]
  double lower = -10;        ///< of its range
  double upper = 10;
  bool is_clamped = false;
  bool is_locked = false;

  bool IsHeld() const { return is_locked || (is_clamped && lower == upper); }  ///< where it is
};

/// constant + the sum of functions of one coordinate each.
struct OsimExpression {
  struct Term {
    std::string coordinate;
    ScalarFunction function;
  };
  std::vector<Term> terms;
  double constant = 0;
};

/// A turn about an axis, or a shift along it.
struct OsimAxis {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< unit vector
  OsimExpression value;                             ///< [rad] or [m]
};

/// X_FM = T(translations) Rot(rotation 0) Rot(rotation 1) Rot(rotation 2), all about axes of F.
struct OsimJoint {
  std::string name;
  std::string type;  ///< "CustomJoint"
  int line = 0;
  int parent = 0;                                          ///< index of the body
  int child = 0;                                           ///< index of the body
  Eigen::Isometry3d X_PF = Eigen::Isometry3d::Identity();  ///< in the parent body [m]
  Eigen::Isometry3d X_CM = Eigen::Isometry3d::Identity();  ///< in the child body [m]
  std::array<OsimAxis, 3> rotations, translations;
  std::vector<int> coordinates;  ///< indices, in OpenSim's order
};

/// A CoordinateCouplerConstraint that is enforced: the coordinate is the value.
struct OsimCoupler {
  std::string name;
  int line = 0;
  std::string dependent;
  OsimExpression value;  ///< [rad] or [m]
};

struct OsimMarker {
  std::string name;
  int line = 0;
  int body = 0;
  Eigen::Vector3d p_BM = Eigen::Vector3d::Zero();  ///< [m]
  bool is_fixed = false;                           ///< stays where scaling puts it
};

/// What moves in an OpenSim model: `<OpenSimDocument><Model>` of the versions 10901, 203xx, 30000
/// and 40000 to 4xxxx. Forces, muscles and geometry are passed over.
struct OsimDocument {
  std::string name;
  int version = 0;
  Eigen::Vector3d gravity = {0, -9.80665, 0};  ///< [m/s^2]
  std::vector<OsimBody> bodies;
  std::vector<OsimCoordinate> coordinates;  ///< joint by joint, as OpenSim has them
  std::vector<OsimJoint> joints;
  std::vector<OsimCoupler> couplers;
  std::vector<OsimMarker> markers;
  int num_forces = 0;  ///< that are passed over, with muscles
  int num_muscles = 0;
};

/// The content of another file of the model, named relative to it. @throws Error
using OsimPartReader = std::function<std::string(const std::string& name)>;

/// Parses a model. read_part: of sets that stand in files of their own; empty: these are errors.
/// What is suspicious, but can be used, is a warning of diagnostics.
/// @throws Error with the file of diagnostics: not XML, no model, another version, what moves
///         bodies and is not read (by name), numbers that are none, frames that are not there.
OsimDocument ParseOsim(std::string_view content, const OsimPartReader& read_part,
                       Diagnostics* diagnostics);

/// Markers of a MarkerSet file (`--marker-file`): those of the model of the same name move, others
/// come to it. file: named in messages.
/// @throws Error as ParseOsim.
void AddOsimMarkers(std::string_view content, const std::string& file, OsimDocument* document,
                    Warnings* warnings);

}  // namespace mmm_converter
