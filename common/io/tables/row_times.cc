// SPDX-License-Identifier: MIT
#include "common/io/tables/row_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr double kMostPlaces = 1e15;
constexpr double kRoundedStep = 0.3;  // of a step, by which rounded times may differ from even ones

bool IsStated(double rate) { return std::isfinite(rate) && rate > 0; }

/// Of the steps that go on; NaN where there is none.
double MedianStep(const std::vector<double>& numbers) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < numbers.size(); ++i) {
    if (numbers[i] > numbers[i - 1]) steps.push_back(numbers[i] - numbers[i - 1]);
  }
  if (steps.empty()) return kNaN;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>((steps.size() - 1) / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

/// Goes from row to row.
class Placing {
 public:
  Placing(RowTimes rows, double said_rate, Warnings* warnings)
      : rows_(std::move(rows)), warnings_(warnings), frame_step_(MedianStep(rows_.frames)) {
    const double median = MedianStep(rows_.times);
    const double said_step = IsStated(said_rate) ? 1 / said_rate : kNaN;
    const bool is_as_said =
        std::abs(median - said_step) <= kRoundedStep * said_step + RoundingOf(said_step);
    step_ = is_as_said || std::isnan(median) ? said_step : median;
    rounding_ = step_ > 0 ? RoundingOf(step_) / step_ : 0;
    tolerance_ = 0.5 + rounding_;
    PassOverOutliers();
  }

  std::vector<std::int64_t> Run() {
    std::vector<std::int64_t> places;
    places.reserve(rows_.times.size());
    last_ = 0;
    for (std::size_t k = 0; k < rows_.times.size(); ++k) {
      if (k > 0) Advance(k);
      places.push_back(static_cast<std::int64_t>(last_));
    }
    Tell();
    return places;
  }

  double last() const { return last_; }
  double step() const { return step_; }
  const std::vector<double>& times() const { return rows_.times; }

 private:
  /// By which a step between two times may be rounded [s]: none where it is a multiple of the unit.
  double RoundingOf(double step) const {
    const double units = std::round(step / rows_.resolution);
    const bool is_exact = units >= 1 && std::abs(step / rows_.resolution / units - 1) < 1e-6;
    return rows_.resolution > 0 && !is_exact ? rows_.resolution : 0;
  }

  void PassOverOutliers() {
    std::vector<double>& t = rows_.times;
    for (std::size_t k = 1; k + 1 < t.size(); ++k) {
      const bool is_between = t[k - 1] < t[k] && t[k] < t[k + 1];
      const double across = t[k + 1] - t[k - 1];
      if (!is_between && across > 0 && across <= (1.5 + tolerance_) * step_) t[k] = kNaN;
    }
  }

  void Advance(std::size_t k) {
    const double by_frame = (rows_.frames[k] - rows_.frames[k - 1]) / frame_step_;
    const bool counts = by_frame >= 1 && by_frame == std::floor(by_frame);
    const double by_time = (rows_.times[k] - rows_.times[k - 1]) / step_;
    // What double precision loses in a time.
    const double lost = 4.5e-16 * (std::abs(rows_.times[k]) + std::abs(rows_.times[k - 1])) / step_;
    const double tolerance = tolerance_ + lost;
    double steps = 1;
    if (!std::isfinite(by_time)) {
      if (counts) steps = by_frame;
      // Where all rows go back, there is no step to measure by.
      const bool goes_back =
          by_frame < 1 || rows_.times[k] < rows_.times[k - 1] ||
          (!(rows_.times[k] > rows_.times[k - 1]) && rows_.frames[k] <= rows_.frames[k - 1]);
      if (goes_back) GoBack(k);
    } else if (by_time < 0 || (by_time == 0 && rounding_ == 0)) {
      GoBack(k);
    } else if (counts && std::abs(by_time - by_frame) <= tolerance) {
      steps = by_frame;
    } else if (by_time - 1 > tolerance) {
      steps = std::round(by_time);
    } else if (std::isfinite(by_frame) && by_frame != 1) {
      ++miscounted_;
    }
    steps = std::min(steps, kMostPlaces - last_);
    if (steps > 1) TellGap(k, steps);
    last_ += std::max(steps, 1.0);
  }

  void GoBack(std::size_t k) {
    if (back_++ > 0) return;
    first_back_ =
        std::isfinite(rows_.times[k] - rows_.times[k - 1])
            ? fmt::format("time goes from {:.6g} s to {:.6g} s", rows_.times[k - 1], rows_.times[k])
            : fmt::format("frames are counted from {:.0f} to {:.0f}", rows_.frames[k - 1],
                          rows_.frames[k]);
  }

  void TellGap(std::size_t k, double steps) {
    std::string where = fmt::format("behind row {}", k);
    if (std::isfinite(rows_.frames[k] - rows_.frames[k - 1])) {
      where = fmt::format("between frames {:.0f} and {:.0f}", rows_.frames[k - 1], rows_.frames[k]);
    }
    if (std::isfinite(rows_.times[k] - rows_.times[k - 1])) {
      where += fmt::format(" ({:.6g} s and {:.6g} s)", rows_.times[k - 1], rows_.times[k]);
    }
    WarnOfKind(warnings_, "gaps in time",
               fmt::format("{:.0f} frame{} missing {}: a gap in which nothing is seen", steps - 1,
                           steps > 2 ? "s are" : " is", where));
  }

  void Tell() const {
    if (back_ > 0) {
      Warn(warnings_,
           fmt::format("{}{}; what follows is taken as coming right after", first_back_,
                       back_ > 1 ? fmt::format(", and {} more such steps back", back_ - 1) : ""));
    }
    if (miscounted_ > 0) {
      Warn(warnings_, fmt::format("frame numbers skip or go back {} times where time goes on "
                                  "evenly; time counts",
                                  miscounted_));
    }
  }

  RowTimes rows_;
  Warnings* warnings_;
  double frame_step_;
  double step_ = 0;       // [s]
  double rounding_ = 0;   // of times, in steps
  double tolerance_ = 0;  // in steps
  double last_ = 0;
  long back_ = 0, miscounted_ = 0;
  std::string first_back_;
};

/// The even rate of the times, if they have one.
std::optional<double> RateOf(const std::vector<double>& times,
                             const std::vector<std::int64_t>& places, double last) {
  if (times.size() < 2 || !(times.back() > times.front())) return std::nullopt;
  const double step = (times.back() - times.front()) / last;
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (std::isnan(times[k])) continue;
    const double even = times.front() + step * static_cast<double>(places[k]);
    if (!(std::abs(times[k] - even) <= 0.5 * step)) return std::nullopt;
  }
  return 1 / step;
}

double ChooseRate(double said_rate, const std::optional<double>& by_times, Warnings* warnings) {
  if (!IsStated(said_rate)) return by_times.value_or(0);
  // Times are rounded, over a whole file to far less than that.
  if (!by_times || std::abs(*by_times / said_rate - 1) < 0.01) return said_rate;
  Warn(warnings, fmt::format("the file says {} Hz, its time column {:.6g} Hz; the latter is used",
                             said_rate, *by_times));
  return *by_times;
}

/// Takes out rows that repeat the frame and the time of the one before; returns which they are.
std::vector<bool> TakeOutRepeated(RowTimes* rows, Warnings* warnings) {
  std::vector<bool> repeats(rows->times.size(), false);
  std::size_t kept = 1;
  for (std::size_t k = 1; k < rows->times.size(); ++k) {
    const double frame = rows->frames[k];
    const double time = rows->times[k];
    repeats[k] = frame == rows->frames[kept - 1] && time == rows->times[kept - 1];
    if (repeats[k]) continue;
    rows->frames[kept] = frame;
    rows->times[kept++] = time;
  }
  if (kept < repeats.size()) {
    Warn(warnings,
         fmt::format("{} rows repeat the frame before them; left out", repeats.size() - kept));
  }
  rows->frames.resize(kept);
  rows->times.resize(kept);
  return repeats;
}

}  // namespace

RowPlaces PlaceRows(RowTimes rows, double said_rate, Warnings* warnings) {
  RowPlaces placed;
  if (rows.times.empty()) return placed;
  const double frame = rows.frames.front();
  const double time = rows.times.front();
  if (std::abs(frame) < 1e9) placed.first_frame = std::lround(frame);
  const std::vector<bool> repeats = TakeOutRepeated(&rows, warnings);
  Placing placing(std::move(rows), said_rate, warnings);
  const std::vector<std::int64_t> places = placing.Run();
  placed.num_places = places.back() + 1;
  auto next = places.begin();
  for (const bool is_repeated : repeats) placed.places.push_back(is_repeated ? -1 : *next++);
  std::optional<double> by_times = RateOf(placing.times(), places, placing.last());
  if (!by_times && !IsStated(said_rate) && std::isfinite(placing.step())) {
    by_times = 1 / placing.step();
  }
  placed.rate = ChooseRate(said_rate, by_times, warnings);
  // A capture begins with frame 1 at 0 s.
  const double counted = static_cast<double>(std::max(placed.first_frame - 1, 0L));
  placed.first_time = std::isfinite(time) ? time : placed.rate > 0 ? counted / placed.rate : 0;
  return placed;
}

}  // namespace mmm_converter
