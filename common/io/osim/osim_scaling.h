// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/io/osim/osim_document.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// How the bodies of a model become a person's.
struct OsimScaling {
  std::map<std::string, Eigen::Vector3d> factors;  ///< along a body's axes; others keep their size
  std::optional<double> mass;  ///< of the whole model [kg]; nothing: as it comes
  /// The bodies keep their shares of the mass; else it goes with their volume first.
  bool keeps_mass_distribution = true;
};

/// The text of a model, scaled as OpenSim's tool does it: joints, centres of mass, wrapping
/// surfaces, paths and markers with their bodies, inertias with mass and size, lengths of fibres
/// and tendons by their path's length at the default posture. What has no size stays byte for byte.
/// file: named in messages.
/// @throws Error as ParseOsim, where a set stands in a file of its own, and where a body is not
/// there
///         or would have no size.
std::string ScaleOsim(std::string_view content, const std::string& file, const OsimScaling& scaling,
                      Warnings* warnings);

/// Joints, centres of mass and markers as ScaleOsim leaves them; masses stay. factors: by body.
OsimDocument ScaleOsimDocument(OsimDocument document, const std::vector<Eigen::Vector3d>& factors);

/// The text with these markers: those that it has move to their place and body, others are added.
/// document: whose bodies the markers name. @throws Error as ScaleOsim.
std::string WriteOsimMarkers(std::string_view content, const std::string& file,
                             const OsimDocument& document, const std::vector<OsimMarker>& markers);

}  // namespace mmm_converter
