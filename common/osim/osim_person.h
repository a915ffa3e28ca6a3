// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "common/io/osim/scale_setup.h"
#include "common/motion/marker_sequence.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// A model of OpenSim that has become a person's.
struct ScaledOsim {
  std::string content;                             ///< of its file
  std::map<std::string, Eigen::Vector3d> factors;  ///< of the bodies that change their size
  double mass = 0;                                 ///< [kg]
  int placed_markers = 0;                          ///< that were moved onto the recording's
  double distance = 0;  ///< rms over the markers with tasks, before these moved [m]
};

/// A file of the model or of the set-up, for messages.
struct NamedText {
  std::string_view content;
  std::string file;
};

/// Scales a model by a set-up as OpenSim's tool does: the factors of bodies are measured distances
/// between markers over those of the model, means over pairs and frames; then the posture of
/// OpenSim's inverse kinematics in the mean frame is found, and markers move there but for those
/// that are fixed. markers: of MarkerSet files, in that order.
/// @throws Error where a marker that the set-up measures with is not there, or never seen.
ScaledOsim ScaleOsimPerson(const NamedText& model, const std::vector<NamedText>& markers,
                           const ScaleSetup& setup, const std::string& setup_file,
                           const MarkerSequence& recording, Warnings* warnings);

}  // namespace mmm_converter
