// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "common/convert/motion_converter.h"
#include "common/motion/marker_residuals.h"
#include "common/support/units.h"

namespace mmm_converter {

/// Figures of a conversion that its verdict, its summary and the results of a batch have alike.
struct ConversionFigures {
  ResidualSummary distance;                 ///< over all seen markers and frames [m]
  std::vector<ResidualSummary> of_markers;  ///< the same of each assignment
  int worst_marker = -1;                    ///< assignment with the largest mean; -1: none was seen
  int frames_with_missing_markers = 0;
  int frames_not_converged = 0;
  int frames_reassembled = 0;
  /// NIS over its degrees of freedom, mean over the frames in which the converter states one; NaN:
  /// it never does.
  double nis = kNaN;
  double median_ms = 0, p99_ms = 0;  ///< time of a frame
};

ConversionFigures MeasureConversion(const ConversionResult& result);

}  // namespace mmm_converter
