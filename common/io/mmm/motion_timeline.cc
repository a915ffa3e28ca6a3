// SPDX-License-Identifier: MIT
#include "common/io/mmm/motion_timeline.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr double kRateOfASingleTime = 100;
constexpr double kMostTimelineFrames = 1e15;
constexpr double kHalfNanosecond = 0.5e-9;  // of the nine decimals that are written here

double MedianStep(const std::vector<double>& times) {
  std::vector<double> steps(times.size() - 1);
  for (std::size_t i = 0; i < steps.size(); ++i) steps[i] = times[i + 1] - times[i];
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>((steps.size() - 1) / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

/// Counted step by step: coarse timestamps then add up to no drift.
std::vector<std::int64_t> FramesOf(const std::vector<double>& times, double step) {
  std::vector<std::int64_t> frames = {0};
  frames.reserve(times.size());
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double steps = std::max(1.0, std::round((times[i] - times[i - 1]) / step));
    const double next = static_cast<double>(frames.back()) + steps;
    frames.push_back(static_cast<std::int64_t>(std::min(next, kMostTimelineFrames)));
  }
  return frames;
}

double HalfUnitOfSixDigits(double time) {
  if (time == 0) return 0;
  return 0.5 * std::pow(10.0, std::floor(std::log10(std::abs(time))) - 5);
}

/// The plainest rate at which every time lies within half_unit of its frame; 0: there is none.
template <typename HalfUnit>
double PlainestRate(const std::vector<double>& times, const std::vector<std::int64_t>& frames,
                    HalfUnit half_unit) {
  double low = 0;
  double high = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double time = times[i] - times[0];
    const double tolerance = half_unit(times[i]);
    const auto frame = static_cast<double>(frames[i]);
    low = std::max(low, frame / (time + tolerance));
    if (time > tolerance) high = std::min(high, frame / (time - tolerance));
  }
  if (!(low <= high) || std::isinf(high)) return 0;
  const double middle = 0.5 * (low + high);
  for (int decimals = 0; decimals <= 12; ++decimals) {
    const double scale = std::pow(10.0, decimals);
    const double rate = std::round(middle * scale) / scale;
    if (rate > 0 && low <= rate && rate <= high) return rate;
  }
  return middle;
}

}  // namespace

TimeGrid FitTimeGrid(const std::vector<double>& times) {
  TimeGrid grid;
  if (times.empty()) return grid;
  grid.first_time = times[0];
  grid.rate = kRateOfASingleTime;
  grid.frames = {0};
  if (times.size() == 1) return grid;
  grid.frames = FramesOf(times, MedianStep(times));
  // The last term is what double precision loses in a time.
  grid.rate = PlainestRate(times, grid.frames,
                           [](double time) { return kHalfNanosecond + 4e-16 * std::abs(time); });
  if (grid.rate > 0) return grid;
  grid.rate = PlainestRate(times, grid.frames, [&](double time) {
    return std::max(kHalfNanosecond, HalfUnitOfSixDigits(time)) + HalfUnitOfSixDigits(times[0]);
  });
  if (grid.rate > 0) return grid;
  grid.rate = static_cast<double>(grid.frames.back()) / (times.back() - times[0]);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double off = (times[i] - times[0]) * grid.rate - static_cast<double>(grid.frames[i]);
    if (std::abs(off) > 0.25) grid.even = false;
  }
  return grid;
}

std::vector<double> FrameTimes(const TimeGrid& grid, const std::vector<double>& times) {
  std::vector<double> frame_times;
  frame_times.reserve(static_cast<std::size_t>(grid.num_frames()));
  for (std::size_t i = 0; i < times.size(); ++i) {
    const auto missing =
        i == 0 ? 0 : grid.frames[i] - static_cast<std::int64_t>(frame_times.size());
    for (std::int64_t k = 1; k <= missing; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(missing + 1);
      frame_times.push_back(times[i - 1] + share * (times[i] - times[i - 1]));
    }
    frame_times.push_back(times[i]);
  }
  return frame_times;
}

Eigen::MatrixXd Resample(const TimedRows& rows, const std::vector<double>& times, double hold) {
  using Column = Eigen::Map<const Eigen::VectorXd>;
  Eigen::MatrixXd resampled =
      Eigen::MatrixXd::Constant(rows.width, static_cast<Eigen::Index>(times.size()), kNaN);
  if (rows.times.empty()) return resampled;
  std::size_t next = 0;  // the first row at or after the time
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double time = times[i];
    while (next < rows.times.size() && rows.times[next] < time) ++next;
    auto column = resampled.col(static_cast<Eigen::Index>(i));
    const std::size_t last = std::min(next, rows.times.size() - 1);
    const bool between = next > 0 && next < rows.times.size() && rows.times[next] > time;
    if (between) {
      const double before = rows.times[next - 1];
      const double share = (time - before) / (rows.times[next] - before);
      const Column a(rows.row(next - 1), rows.width);
      const Column b(rows.row(next), rows.width);
      column = a + share * (b - a);
    } else if (std::abs(rows.times[last] - time) <= hold) {
      column = Column(rows.row(last), rows.width);
    }
  }
  return resampled;
}

}  // namespace mmm_converter
