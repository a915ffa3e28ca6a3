// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "MMMConverterS2KF/report/json.h"
#include "common/forces/plate_forces.h"
#include "common/io/c3d/c3d_analog.h"
#include "common/io/c3d/c3d_events.h"
#include "common/io/c3d/c3d_points.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// What a C3D file holds, whether or not it is a recording of markers.
struct C3dDetails {
  std::vector<std::string> labels;  ///< of points
  std::vector<std::string> outputs;
  std::vector<C3dPointCounts> points;
  C3dAnalog analog;
  std::vector<C3dEvent> events;
  std::vector<C3dForcePlate> plates;
  RecordedForces forces;  ///< of those plates that can be read
};

/// Reads the whole file once. @throws Error where it has become shorter meanwhile.
C3dDetails ReadC3dDetails(C3dFile* file, Warnings* warnings);

/// A line for each kind of content, then tables.
std::string FormatC3dDetails(const C3dFile& file, const C3dDetails& details);

/// Adds the members stored, positions, points, analog, force_plates, events and parameters.
void AddC3dDetails(const C3dFile& file, const C3dDetails& details, Json* json);

}  // namespace mmm_converter
