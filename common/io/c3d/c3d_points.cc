// SPDX-License-Identifier: MIT
#include "common/io/c3d/c3d_points.h"

#include <cmath>

#include "common/io/c3d/c3d_data.h"
#include "common/io/c3d/c3d_numbers.h"

namespace mmm_converter {
namespace {

/// Adds a stored point; `residual` is a sum here.
void Count(const unsigned char* stored, const C3dLayout& layout, C3dPointCounts* counts) {
  const C3dPointWord word = DecodeC3dPointWord(stored, layout);
  double xyz[3];
  DecodeC3dPosition(stored, layout, xyz);
  if (!word.valid) {
    ++counts->marked_invalid;
  } else if (!IsC3dPosition(xyz)) {
    ++counts->no_position;
  } else if (xyz[0] == 0 && xyz[1] == 0 && xyz[2] == 0) {
    ++counts->at_origin;
  } else {
    ++counts->seen;
    if (!word.known) return;
    counts->interpolated += word.residual == 0;
    counts->measured += word.residual > 0;
    counts->residual += word.residual * layout.scale;
  }
}

}  // namespace

std::vector<C3dPointCounts> CountC3dPoints(C3dFile* file) {
  const C3dLayout& layout = file->layout();
  std::vector<C3dPointCounts> points(layout.points);
  if (points.empty()) return points;
  const std::size_t point_bytes = layout.floats ? 16 : 8;
  file->ReadAllFrames([&](int, int count, const unsigned char* stored) {
    for (int i = 0; i < count; ++i) {
      const unsigned char* const frame = stored + i * layout.frame_bytes;
      for (std::size_t p = 0; p < points.size(); ++p) {
        Count(frame + p * point_bytes, layout, &points[p]);
      }
    }
  });
  for (C3dPointCounts& counts : points) {
    if (counts.measured > 0) counts.residual /= static_cast<double>(counts.measured);
  }
  return points;
}

C3dPointCounts Total(const std::vector<C3dPointCounts>& points) {
  C3dPointCounts total;
  for (const C3dPointCounts& counts : points) {
    total.seen += counts.seen;
    total.marked_invalid += counts.marked_invalid;
    total.at_origin += counts.at_origin;
    total.no_position += counts.no_position;
    total.interpolated += counts.interpolated;
    total.measured += counts.measured;
    total.residual += counts.residual * static_cast<double>(counts.measured);
  }
  if (total.measured > 0) total.residual /= static_cast<double>(total.measured);
  return total;
}

}  // namespace mmm_converter
