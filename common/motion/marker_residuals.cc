// SPDX-License-Identifier: MIT
#include "common/motion/marker_residuals.h"

#include <cmath>
#include <span>

#include "common/math/statistics.h"

namespace mmm_converter {
namespace {

std::span<const double> Numbers(const Eigen::Ref<const Eigen::VectorXd>& values) {
  return {values.data(), static_cast<std::size_t>(values.size())};
}

ResidualSummary Summarize(std::span<const double> distances) {
  ResidualSummary summary;
  for (const double distance : distances) summary.seen += std::isnan(distance) ? 0 : 1;
  summary.mean = Mean(distances);
  summary.median = Median(distances);
  summary.p95 = Percentile(distances, 95);
  summary.max = Max(distances);
  return summary;
}

}  // namespace

ResidualSummary SummarizeResiduals(const Eigen::MatrixXd& residuals) {
  return Summarize({residuals.data(), static_cast<std::size_t>(residuals.size())});
}

std::vector<ResidualSummary> SummarizeEachMarker(const Eigen::MatrixXd& residuals) {
  std::vector<ResidualSummary> summaries;
  for (Eigen::Index marker = 0; marker < residuals.rows(); ++marker) {
    const Eigen::VectorXd distances = residuals.row(marker);
    summaries.push_back(Summarize(Numbers(distances)));
  }
  return summaries;
}

Eigen::VectorXd MeanOfEachFrame(const Eigen::MatrixXd& residuals) {
  Eigen::VectorXd means(residuals.cols());
  for (Eigen::Index k = 0; k < means.size(); ++k) means[k] = Mean(Numbers(residuals.col(k)));
  return means;
}

int FramesWithMissingMarkers(const Eigen::MatrixXd& residuals) {
  int frames = 0;
  for (Eigen::Index k = 0; k < residuals.cols(); ++k) frames += residuals.col(k).hasNaN() ? 1 : 0;
  return frames;
}

int FramesBeforeFirstSeen(const Eigen::MatrixXd& residuals) {
  Eigen::Index first = 0;
  while (first < residuals.cols() && residuals.col(first).array().isNaN().all()) ++first;
  return first < residuals.cols() ? static_cast<int>(first) : 0;
}

}  // namespace mmm_converter
