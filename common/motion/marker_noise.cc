// SPDX-License-Identifier: MIT
#include "common/motion/marker_noise.h"

#include <algorithm>
#include <cmath>

#include "common/math/statistics.h"

namespace mmm_converter {
namespace {

constexpr int kDifferences = 10;      // third differences of a marker that are looked at together
constexpr int kMostWindows = 200;     // spread over the recording
constexpr double kQuietest = 10;      // percent of the windows
constexpr double kNoiseSquares = 20;  // variance of a third difference of noise: 1 + 9 + 9 + 1

}  // namespace

double MeasureMarkerNoise(const MarkerSequence& recording, const std::vector<LabelIx>& labels) {
  constexpr int kFrames = kDifferences + 3;
  std::vector<double> deviations;
  const int windows = std::min(kMostWindows, recording.num_frames() / kFrames);
  for (int w = 0; w < windows; ++w) {
    const long spare = recording.num_frames() - kFrames;
    const int begin = windows == 1 ? 0 : static_cast<int>(spare * w / (windows - 1));
    for (const int label : labels) {
      double squares = 0;
      for (int k = begin; k < begin + kDifferences; ++k) {
        const auto p = [&](int i) -> Eigen::Vector3d { return recording.frame(k + i).col(label); };
        squares += (p(3) - 3 * p(2) + 3 * p(1) - p(0)).squaredNorm();
      }
      deviations.push_back(std::sqrt(squares / (3 * kDifferences * kNoiseSquares)));
    }
  }
  return Percentile(deviations, kQuietest);
}

}  // namespace mmm_converter
