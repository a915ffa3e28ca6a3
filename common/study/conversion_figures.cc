// SPDX-License-Identifier: MIT
#include "common/study/conversion_figures.h"

#include <algorithm>
#include <cmath>

#include "common/math/statistics.h"

namespace mmm_converter {
namespace {

int WorstMarker(const std::vector<ResidualSummary>& of_markers) {
  int worst = -1;
  for (std::size_t i = 0; i < of_markers.size(); ++i) {
    if (std::isnan(of_markers[i].mean)) continue;
    if (worst < 0 || of_markers[i].mean > of_markers[static_cast<std::size_t>(worst)].mean) {
      worst = static_cast<int>(i);
    }
  }
  return worst;
}

}  // namespace

ConversionFigures MeasureConversion(const ConversionResult& result) {
  ConversionFigures figures;
  figures.distance = SummarizeResiduals(result.residuals);
  figures.of_markers = SummarizeEachMarker(result.residuals);
  figures.worst_marker = WorstMarker(figures.of_markers);
  figures.frames_with_missing_markers = FramesWithMissingMarkers(result.residuals);
  std::vector<double> times;
  std::vector<double> nis;
  for (const FrameDiagnostic& frame : result.frames) {
    figures.frames_not_converged += frame.converged ? 0 : 1;
    figures.frames_reassembled += frame.reassembled ? 1 : 0;
    if (frame.nis > 0) nis.push_back(frame.nis);
    if (frame.seconds > 0) times.push_back(1e3 * frame.seconds);
  }
  figures.nis = Mean(nis);
  figures.median_ms = Median(times);
  figures.p99_ms = Percentile(times, 99);
  return figures;
}

}  // namespace mmm_converter
