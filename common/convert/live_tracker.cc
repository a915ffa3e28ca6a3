// SPDX-License-Identifier: MIT
#include "common/convert/live_tracker.h"

#include <cmath>
#include <utility>

namespace mmm_converter {
namespace {

constexpr double kRounding = 1e-4;  // of a step

}  // namespace

LiveTracker::LiveTracker(std::unique_ptr<MotionConverter> converter, double rate)
    : converter_(std::move(converter)), rate_(rate), start_(setup()) {}

double LiveTracker::StepTo(double time) const {
  const double dt = time - time_;
  if (rate_ <= 0) return dt;
  const double steps = std::round(dt * rate_);
  return std::abs(dt * rate_ - steps) < kRounding ? steps / rate_ : dt;
}

bool LiveTracker::IsOver(double time, int seen) {
  if (time <= time_ || time - time_ > kLongestGap) return true;
  if (seen >= kFewestMarkers) seen_time_ = time;
  return time - seen_time_ > kLongestGap;
}

void LiveTracker::Prepare() {
  if (is_tracking_ && rate_ > 0) converter_->Prepare(1 / rate_);
}

const FrameEstimate* LiveTracker::Track(const Eigen::Ref<const Eigen::Matrix3Xd>& points,
                                        double time) {
  const int seen = CountSeen(points, setup());
  if (is_tracking_ && IsOver(time, seen)) is_tracking_ = false;
  const double dt = StepTo(time);
  time_ = time;
  if (is_tracking_) return &converter_->Track(points, dt);
  if (!start_.IsAt(time, seen)) return nullptr;
  const FrameEstimate& estimate = converter_->Assemble(points);
  is_tracking_ = true;
  seen_time_ = time;
  ++starts_;
  return &estimate;
}

}  // namespace mmm_converter
