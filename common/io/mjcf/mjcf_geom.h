// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

#include "common/io/mjcf/mjcf_values.h"
#include "common/model/robot.h"

namespace mmm_converter {

/// A mass and how it is spread, in the axes of a body.
struct MjcfMass {
  double mass = 0;                                    ///< [kg]
  Eigen::Vector3d p_BC = Eigen::Vector3d::Zero();     ///< its centre [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about it [kg m^2]

  void Add(const MjcfMass& other);
};

struct MjcfGeom {
  bool touches = true;                ///< not only looked at
  std::optional<ContactShape> shape;  ///< `segment` is not set; nothing: a mesh or the like
  std::optional<MjcfMass> mass;       ///< nothing: of a mesh, whose size is not known
};

/// Of a `<geom>`. X_BF: of the frame around it in the body.
MjcfGeom ReadMjcfGeom(const MjcfAttributes& attributes, const Eigen::Isometry3d& X_BF,
                      const XmlElement& element, MjcfText* text);

/// Of an `<inertial>`.
MjcfMass ReadMjcfInertial(const MjcfAttributes& attributes, const Eigen::Isometry3d& X_BF,
                          const XmlElement& element, MjcfText* text);

}  // namespace mmm_converter
