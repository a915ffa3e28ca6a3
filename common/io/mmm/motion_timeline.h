// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace mmm_converter {

/// Measurements as a file has them: strictly increasing times [s] and `width` numbers for each.
struct TimedRows {
  int width = 0;
  std::vector<double> times;
  std::vector<double> values;

  const double* row(std::size_t i) const { return values.data() + i * width; }
};

/// The even time grid that runs through increasing times: frame f is at first_time + f / rate.
struct TimeGrid {
  double rate = 0;                   ///< [Hz]
  double first_time = 0;             ///< [s]
  std::vector<std::int64_t> frames;  ///< the frame of each time, from 0, increasing
  bool even = true;                  ///< every time lies within a quarter of a step of its frame

  /// At most 1e15, where `frames` are no longer to be trusted.
  std::int64_t num_frames() const { return frames.empty() ? 0 : frames.back() + 1; }
};

/// The grid at the median step; a single time gets 100 Hz. Of the rates that give the times to the
/// digits that they were written with (nine decimals, or six digits), the one with the fewest
/// decimals.
TimeGrid FitTimeGrid(const std::vector<double>& times);

/// A time for every frame of the grid: the given one, or between two given ones the interpolated
/// one.
std::vector<double> FrameTimes(const TimeGrid& grid, const std::vector<double>& times);

/// Rows at other, increasing times, linearly interpolated; width x times. The first and the last
/// row hold for `hold` seconds beyond, further out it is NaN.
Eigen::MatrixXd Resample(const TimedRows& rows, const std::vector<double>& times, double hold);

}  // namespace mmm_converter
