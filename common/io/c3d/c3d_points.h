// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "common/io/c3d/c3d_file.h"

namespace mmm_converter {

/// How often a point is there, and why not: the first four counts add up to the frames.
struct C3dPointCounts {
  long seen = 0;            ///< C3dReader::ReadPoints gives a position
  long marked_invalid = 0;  ///< by its residual
  long at_origin = 0;       ///< exactly (0,0,0), not marked: not seen
  long no_position = 0;     ///< not finite or further than 1e6 from the origin, not marked
  long interpolated = 0;    ///< of the seen: residual 0, which means interpolated or computed
  long measured = 0;        ///< of the seen: residual above 0
  double residual = 0;      ///< mean of the measured, in the file's unit
};

/// One for each point. Reads the whole file, with one buffer.
std::vector<C3dPointCounts> CountC3dPoints(C3dFile* file);

/// The sum over all points; residual is their mean.
C3dPointCounts Total(const std::vector<C3dPointCounts>& points);

}  // namespace mmm_converter
