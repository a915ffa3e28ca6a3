// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "common/io/osim/osim_document.h"
#include "common/model/kinematic_model.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// Makes a model of bodies, joints and markers as OpenSim has them; ground's axes are turned so
/// that z, against gravity, points up. coordinates() are those of the file, under whose names joint
/// angles are. Locked coordinates and those that couplers tell have no joint; clamped ones are
/// limited, others have their range's half as reach. A root that hangs on ground by six free
/// coordinates, about axes at right angles, floats (without their limits); any other model has
/// ground as its fixed root.
/// @throws Error with the file of diagnostics: bodies that hang in circles or on nothing, two
///         joints of one body, couplers of unknown or each other's coordinates.
KinematicModel MakeOsimModel(const OsimDocument& document, Diagnostics* diagnostics);

/// Parses a model with the files that it names, which are beside it; marker_file: AddOsimMarkers;
/// empty: none. @throws Error as ParseOsim.
OsimDocument ParseOsimDocument(std::string_view content, const std::string& marker_file,
                               Diagnostics* diagnostics, Warnings* warnings);

/// Reads a model with the files that it names. marker_file: AddOsimMarkers; empty: none.
/// @throws Error as ParseOsim and MakeOsimModel.
KinematicModel ReadOsimModel(const std::string& path, const std::string& marker_file = {},
                             Warnings* warnings = nullptr);

/// As ReadOsimModel; `file` is named in messages, and the model's other files are beside it.
KinematicModel ParseOsimModel(std::string_view content, const std::string& file,
                              const std::string& marker_file = {}, Warnings* warnings = nullptr);

}  // namespace mmm_converter
