// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "MMMConverterS2KF/report/json.h"
#include "common/io/c3d/c3d_analog.h"
#include "common/io/c3d/c3d_events.h"
#include "common/io/c3d/c3d_points.h"

namespace mmm_converter {

/// What a C3D file holds, whether or not it is a recording of markers.
struct C3dContent {
  std::vector<std::string> labels;  ///< of points
  std::vector<std::string> outputs;
  std::vector<C3dPointCounts> points;
  C3dAnalog analog;
  std::vector<C3dEvent> events;
  std::vector<C3dForcePlate> plates;
  std::vector<std::string> warnings;  ///< those of the file too
};

/// Reads the whole file once. @throws Error where it has become shorter meanwhile.
C3dContent ReadC3dContent(C3dFile* file);

/// A line for each kind of content, then tables.
std::string FormatC3dContent(const C3dFile& file, const C3dContent& content);

/// Adds the members points, marks, processor, analog, events, force_plates and parameters.
void AddC3dContent(const C3dFile& file, const C3dContent& content, Json* json);

}  // namespace mmm_converter
