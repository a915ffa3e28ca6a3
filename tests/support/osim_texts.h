// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>

#include "common/model/coordinate_map.h"

namespace mmm_converter::testing {

/// A coordinate; more: further properties.
std::string OsimCoordinateText(const std::string& name, const std::string& more = "");

/// An axis of a Custom joint, by its name ("rotation1").
std::string OsimAxisText(const std::string& name, const std::string& coordinate,
                         const std::string& axis, const std::string& function);

/// A body of 1 kg.
std::string OsimBodyText(const std::string& name);

/// A joint of version 4 between two bodies; more: coordinates and transform. The child's frame and
/// the parent's are turned and shifted.
std::string OsimJointText(const std::string& type, const std::string& name,
                          const std::string& parent, const std::string& child,
                          const std::string& more = "");

std::string OsimMarkerText(const std::string& name, const std::string& body,
                           const std::string& location);

/// A document of version 4.
std::string OsimText(const std::string& bodies, const std::string& joints,
                     const std::string& constraints = "", const std::string& markers = "");

/// A model with every kind of joint and function that is read: root by six free coordinates,
/// oblique axes, functions of all kinds, a coupler, a locked and clamped coordinates, markers on
/// all bodies.
std::string OsimOfAllKinds();

/// The rows of a motion of OpenSim, old or new, in degrees: coordinates x rows [rad, m], defaults
/// where the file has no column.
Eigen::MatrixXd OsimCoordinates(const std::string& motion, const CoordinateMap& map);

}  // namespace mmm_converter::testing
