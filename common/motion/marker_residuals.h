// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

namespace mmm_converter {

/// Distances between measured and model markers [m], over those that were seen; NaN where none was.
struct ResidualSummary {
  long seen = 0;
  double mean = 0;
  double median = 0;
  double p95 = 0;  ///< 95th percentile
  double max = 0;
};

// `residuals` is markers x frames [m]; NaN: not seen.

ResidualSummary SummarizeResiduals(const Eigen::MatrixXd& residuals);
std::vector<ResidualSummary> SummarizeEachMarker(const Eigen::MatrixXd& residuals);

/// The mean over the seen markers of each frame; NaN: none was seen.
Eigen::VectorXd MeanOfEachFrame(const Eigen::MatrixXd& residuals);

/// The frames in which at least one marker was not seen.
int FramesWithMissingMarkers(const Eigen::MatrixXd& residuals);

/// The frames before the first one in which a marker was seen; 0 where none ever was.
int FramesBeforeFirstSeen(const Eigen::MatrixXd& residuals);

}  // namespace mmm_converter
