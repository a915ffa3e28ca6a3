// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "common/io/mjcf/mjcf_defaults.h"
#include "common/io/mjcf/mjcf_text.h"

namespace mmm_converter {

/// `<compiler>`: of the whole model, whose last word counts.
struct MjcfSettings {
  double angle = EIGEN_PI / 180;  ///< [rad] of the unit of angles
  std::string euler = "xyz";      ///< eulerseq
  bool limits_by_range = true;    ///< autolimits
  enum class Inertia { kAuto, kFromGeoms, kFromInertial } inertia = Inertia::kAuto;
  std::array<double, 2> inertia_groups = {0, 5};
  double total_mass = -1;     ///< [kg]; not above 0: as it comes
  std::string mesh_folder;    ///< meshdir, else assetdir
  bool strips_paths = false;  ///< strippath
};

MjcfSettings ReadMjcfSettings(const MjcfDefaults& defaults, MjcfText* text);

/// Attributes of an element, with those that its class gives it. What is wrong is an error of the
/// text; what it would have been is then returned as if it were not there.
class MjcfAttributes {
 public:
  /// of_class: -1 for elements that have no defaults.
  MjcfAttributes(const XmlElement& element, int of_class, const MjcfDefaults& defaults,
                 const MjcfSettings& settings, MjcfText* text);

  const std::string* Find(std::string_view name) const;  ///< nullptr: nowhere
  std::string Word(std::string_view name, std::string_view otherwise) const;
  /// All of these numbers are finite; nothing where it is not there.
  std::optional<Eigen::VectorXd> Numbers(std::string_view name, int fewest, int most) const;
  double Number(std::string_view name, double otherwise) const;
  Eigen::Vector3d Vector(std::string_view name, const Eigen::Vector3d& otherwise) const;
  /// `pos` and an orientation: quat, axisangle, euler, xyaxes or zaxis [m].
  Eigen::Isometry3d Pose() const;

 private:
  Eigen::Quaterniond Orientation() const;
  Eigen::Quaterniond OrientationBy(std::string_view way) const;
  template <typename... Args>
  void Fail(Args&&... args) const;

  const XmlElement& element_;
  int class_;
  const MjcfDefaults& defaults_;
  const MjcfSettings& settings_;
  MjcfText& text_;
};

/// The smallest turn of z to that direction, which is not zero.
Eigen::Quaterniond TurnOfZ(const Eigen::Vector3d& to);

}  // namespace mmm_converter
