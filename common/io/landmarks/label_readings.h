// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/io/landmarks/landmark_table.h"

namespace mmm_converter {

/// What a label can mean.
struct LabelReading {
  int landmark = -1;  ///< of the table
  BodySide side = BodySide::kNone;
  bool operator==(const LabelReading&) const = default;
};

/// What a label means among the others of its recording.
struct ReadLabel {
  /// The likeliest first; none: nothing is known of it.
  std::vector<LabelReading> readings;
  std::string why_left_out;  ///< "a computed point"; empty: `readings` says what it is
};

/// Landmarks that a label can mean by itself: sides in any spelling, before or behind the landmark
/// or inside ("LASI", "r.ASIS", "Knee_lat_L", "WaistLFront"), without subject (`name:`). Of a sided
/// landmark without side the side is kNone.
std::vector<LabelReading> ReadingsOf(std::string_view label, const LandmarkTable& table);

/// What the labels of one person mean together: sides that need a counterpart have one; the names
/// of keypoints (hip, knee) are joints where no label is of the skin alone; two labels are not the
/// same landmark where another reading is free; computed points and joint centres beside their
/// markers are left out. seen: by label; empty: all are.
std::vector<ReadLabel> ReadLabels(const std::vector<std::string>& labels,
                                  const std::vector<bool>& seen, const LandmarkTable& table);

}  // namespace mmm_converter
