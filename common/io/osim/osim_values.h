// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <string_view>
#include <vector>

#include "common/io/osim/osim_document.h"
#include "common/io/xml/xml_document.h"
#include "common/support/diagnostics.h"

namespace mmm_converter {

// Properties of an OpenSim object: elements below its own, of which those that are not there have a
// default. What is wrong is added to the diagnostics; the default is then returned.

std::string OsimName(const XmlElement& object);  ///< its attribute; empty: it has none

/// The text of a property, trimmed; empty where it is not there.
std::string_view OsimText(const XmlElement& object, std::string_view property);

/// Words of a text, separated by white space.
std::vector<std::string> Words(std::string_view text);

double ReadOsimNumber(const XmlElement& object, std::string_view property, double otherwise,
                      Diagnostics* diagnostics);
bool ReadOsimFlag(const XmlElement& object, std::string_view property, bool otherwise,
                  Diagnostics* diagnostics);
/// count: how many numbers there must be; 0: any number. All finite.
std::vector<double> ReadOsimNumbers(const XmlElement& object, std::string_view property,
                                    std::size_t count, const std::vector<double>& otherwise,
                                    Diagnostics* diagnostics);
Eigen::Vector3d ReadOsimVector(const XmlElement& object, std::string_view property,
                               const Eigen::Vector3d& otherwise, Diagnostics* diagnostics);
/// A pose by two properties: a place [m] and turns about body-fixed x, y and z [rad].
Eigen::Isometry3d ReadOsimPose(const XmlElement& object, std::string_view translation,
                               std::string_view orientation, Diagnostics* diagnostics);

/// An object that is a property: `<property><Type>` or `<Type name="property">`. nullptr: none.
const XmlElement* FindOsimObject(const XmlElement& object, std::string_view property);

/// The `<objects>` of a set that is a property; nullptr: there are none.
const XmlElement* FindOsimObjects(const XmlElement& owner, std::string_view set);

/// A function of these coordinates, by its element; nullptr or an empty property is 0, or the
/// coordinate itself where there is one and `is_identity`. is_pure: out, it is a LinearFunction of
/// one coordinate with the slope 1 or -1; may be null.
OsimExpression ReadOsimFunction(const XmlElement* function,
                                const std::vector<std::string>& coordinates, bool is_identity,
                                bool* is_pure, Diagnostics* diagnostics);

}  // namespace mmm_converter
