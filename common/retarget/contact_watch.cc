// SPDX-License-Identifier: MIT
#include "common/retarget/contact_watch.h"

#include <algorithm>

#include "common/motion/ground_rules.h"

namespace mmm_converter {
namespace {

constexpr double kSpan = 0.01;  // [s] until a frame, of its speed
// [s] in which the level follows: at first it is the model's, up to 60 mm off.
constexpr double kFirstLevelTime = 0.1, kLevelTime = 1;

}  // namespace

Eigen::Vector3d PointWatch::VelocityAt(const Eigen::Vector3d& p_W, double time) const {
  for (int i = 1; i <= count_; ++i) {
    const Sample& before = samples_[(next_ - i + kSamples) % kSamples];
    const double span = time - before.time;
    if (span < kSpan - 1e-6 && i < count_) continue;
    if (!(span > 0)) break;
    return (p_W - before.p) / span;
  }
  return Eigen::Vector3d::Zero();
}

void PointWatch::Take(const Eigen::Vector3d& p_W, double time) {
  velocity_ = VelocityAt(p_W, time);
  const double speed = velocity_.norm();
  const double dt = count_ > 0 ? time - samples_[(next_ - 1 + kSamples) % kSamples].time : 0;
  p_ = p_W;
  is_slow_ = speed < kStillSpeed;
  height_ = p_W.z() - level_ - kLowHeight;
  if (height_ <= 0 && (is_slow_ || (!has_stood_ && speed < kComesBelow))) {
    if (is_slow_ && !has_stood_) told_for_ = 0;
    has_stood_ |= is_slow_;
    told_for_ = std::clamp(told_for_ + dt, kFirstLevelTime, kLevelTime);
    const bool is_below = p_W.z() < level_ - kLowHeight;
    const double part = is_below ? 1 : std::min(1.0, dt / told_for_);
    level_ += part * (p_W.z() - level_);
  }
  const double height = p_W.z() - level_;
  is_on_ = height < (is_on_ ? kLowHeight : kRestHeight) &&
           speed < (is_on_ ? kEndOfRestSpeed : kRestSpeed);
  samples_[next_] = {p_W, time};
  next_ = (next_ + 1) % kSamples;
  count_ = std::min(count_ + 1, kSamples);
}

void PointWatch::Forget() {
  count_ = next_ = 0;
  is_on_ = is_slow_ = false;
}

}  // namespace mmm_converter
