// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "common/math/scalar_function.h"
#include "common/model/kinematic_model.h"
#include "common/model/posture.h"

namespace mmm_converter {

/// A coordinate by which the files of a model describe its postures.
struct ModelCoordinate {
  enum class Kind { kTurn, kShift, kCoupled };  ///< only turns are in degrees, in a file in degrees

  struct Term {
    std::string joint;
    ScalarFunction function;
  };

  std::string name;
  Kind kind = Kind::kCoupled;
  double rest = 0;  ///< [rad, m]
  double lower = 0, upper = 0;
  bool is_clamped = false;  ///< to these
  bool is_locked = false;
  /// Which of the free root's turns (0 to 2) and shifts (3 to 5) it is; -1: it is not of the root,
  /// but the constant and the functions of the model's joint angles together.
  int root = -1;
  double constant = 0;
  std::vector<Term> terms;
};

/// The pose of a free root by six coordinates,
///   X_WS = X_WF T(s) Rot(a_0, v_0) Rot(a_1, v_1) Rot(a_2, v_2) X_MS,  s = sum b_i v_{3+i},
/// with v_k = slope_k q_k + offset_k.
struct FreeRoot {
  Eigen::Isometry3d X_WF = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d X_MS = Eigen::Isometry3d::Identity();
  Eigen::Matrix3d turns = Eigen::Matrix3d::Identity();   ///< columns a_i, each at right angles to
                                                         ///< the two others
  Eigen::Matrix3d shifts = Eigen::Matrix3d::Identity();  ///< columns b_i, regular
  Eigen::Matrix<double, 6, 1> slope = Eigen::Matrix<double, 6, 1>::Ones();
  Eigen::Matrix<double, 6, 1> offset = Eigen::Matrix<double, 6, 1>::Zero();
};

/// How the coordinates of a model's files and the postures of KinematicModel belong together.
class CoordinateMap {
 public:
  CoordinateMap(std::vector<ModelCoordinate> coordinates, std::optional<FreeRoot> root,
                const Eigen::Matrix3d& R_WG)
      : coordinates_(std::move(coordinates)), root_(std::move(root)), R_WG_(R_WG) {}

  const std::vector<ModelCoordinate>& coordinates() const { return coordinates_; }
  const std::optional<FreeRoot>& root() const { return root_; }  ///< nothing: the root is fixed
  /// The axes of the files' ground, which has W's origin.
  const Eigen::Matrix3d& R_WG() const { return R_WG_; }

 private:
  std::vector<ModelCoordinate> coordinates_;
  std::optional<FreeRoot> root_;
  Eigen::Matrix3d R_WG_;
};

/// The coordinates of one posture after the other. Turns of a free root go on from those before
/// without jumps, and start as near to their rests as they can.
class CoordinateSeries {
 public:
  /// model: with coordinates(); must outlive the series.
  explicit CoordinateSeries(const KinematicModel& model);

  /// Values of the next posture, all joints [rad, m].
  const Eigen::VectorXd& Next(const Posture& posture);

  /// Standard deviations of the values that Next returned last, from those of the posture, [root
  /// position (W); root rotation (body); joint angles], as if these were independent [rad, m].
  Eigen::VectorXd Deviations(const Posture& posture, const Eigen::VectorXd& deviations) const;

 private:
  void ReadRoot(const Posture& posture);

  const KinematicModel& model_;
  std::vector<std::vector<int>> joints_;  // of the terms
  Eigen::VectorXd values_;
  Eigen::Matrix<double, 6, 1> of_root_;  // v, of the last posture
};

/// The posture of a model with coordinates() at these values [rad, m]. Those of coordinates that
/// follow others are not used; joints that no coordinate tells are at rest.
Posture PostureOf(const KinematicModel& model, const Eigen::VectorXd& values);
/// The same where all coordinates rest.
Posture RestPosture(const KinematicModel& model);

}  // namespace mmm_converter
