// SPDX-License-Identifier: MIT
#include "common/retarget/contact_watch.h"

#include <algorithm>

#include "common/motion/ground_rules.h"

namespace mmm_converter {
namespace {

constexpr double kSpan = 0.01;    // [s] until a frame, of its speed
constexpr double kLevelTime = 1;  // [s] in which the level follows

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
  if (is_slow_ && height_ <= 0) {
    const bool is_below = p_W.z() < level_ - kLowHeight;
    const double part = is_below ? 1 : std::min(1.0, dt / kLevelTime);
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
