// SPDX-License-Identifier: MIT
#include "common/motion/resampled.h"

#include <algorithm>
#include <cmath>

namespace mmm_converter {
namespace {

constexpr double kSameTime = 1e-6;  // of a frame: what rounding makes of times

/// A cubic from 0 to 1 with values 0 and `step`, and slopes there.
struct Cubic {
  double step, slope0, slope1;

  double At(double u) const {
    return u * u * (3 - 2 * u) * step + u * (u - 1) * (u - 1) * slope0 + u * u * (u - 1) * slope1;
  }
  double SlopeAt(double u) const {
    return 6 * u * (1 - u) * step + (1 - u) * (1 - 3 * u) * slope0 + u * (3 * u - 2) * slope1;
  }
  double LargestSlope() const {
    double largest = std::max(std::abs(slope0), std::abs(slope1));
    const double curvature = 3 * (slope0 + slope1 - 2 * step);
    const double at = curvature == 0 ? -1 : (2 * slope0 + slope1 - 3 * step) / curvature;
    if (at > 0 && at < 1) largest = std::max(largest, std::abs(SlopeAt(at)));
    return largest;
  }
};

class Resampler {
 public:
  Resampler(const PoseTrajectory& motion, const JointBounds& bounds)
      : motion_(motion), bounds_(bounds), last_(motion.num_frames() - 1) {}

  Posture At(double frame) const;

 private:
  /// From frame k on, as a tangent vector there.
  Eigen::VectorXd To(int k, int other) const {
    return Local(FrameAt(k), FrameAt(std::clamp(other, 0, last_)));
  }
  const Posture& FrameAt(int k) const { return motion_.postures[static_cast<std::size_t>(k)]; }
  double AngleAt(Eigen::Index joint, const Cubic& cubic, double start, double u) const;

  const PoseTrajectory& motion_;
  const JointBounds& bounds_;
  int last_;
};

double Resampler::AngleAt(Eigen::Index joint, const Cubic& cubic, double start, double u) const {
  const bool is_fast = cubic.LargestSlope() * motion_.rate > bounds_.velocity[joint];
  const double angle = start + (is_fast ? u * cubic.step : cubic.At(u));
  // Where the frames themselves are beyond the limits, between them.
  const double end = start + cubic.step;
  return std::clamp(angle, std::min({bounds_.lower[joint], start, end}),
                    std::max({bounds_.upper[joint], start, end}));
}

Posture Resampler::At(double frame) const {
  const int k = std::clamp(static_cast<int>(frame), 0, std::max(last_ - 1, 0));
  const double u = frame - k;
  if (u < kSameTime || last_ == 0) return FrameAt(k);
  if (u > 1 - kSameTime) return FrameAt(k + 1);
  const Eigen::VectorXd before = To(k, k - 1), next = To(k, k + 1), behind = To(k, k + 2);
  // At the ends the nearest difference goes on.
  const Eigen::VectorXd slope0 = k > 0 ? Eigen::VectorXd(0.5 * (next - before)) : next;
  const Eigen::VectorXd slope1 = k + 2 <= last_ ? Eigen::VectorXd(0.5 * behind) : next;
  Eigen::VectorXd moved(next.size());
  for (Eigen::Index i = 0; i < moved.size(); ++i) {
    const Cubic cubic{next[i], slope0[i], slope1[i]};
    const double start = i < 6 ? 0 : FrameAt(k).joint_angles[i - 6];
    moved[i] = i < 6 ? cubic.At(u) : AngleAt(i - 6, cubic, start, u) - start;
  }
  return Retract(FrameAt(k), moved);
}

}  // namespace

PoseTrajectory Resample(const PoseTrajectory& motion, double rate, const JointBounds& bounds) {
  PoseTrajectory resampled;
  resampled.rate = rate;
  resampled.first_time = motion.first_time;
  resampled.joint_names = motion.joint_names;
  if (motion.postures.empty()) return resampled;
  const double step = motion.rate / rate;  // frames
  const auto last = static_cast<double>(motion.num_frames() - 1);
  const auto count = static_cast<std::size_t>(last / step + kSameTime) + 1;
  resampled.postures.reserve(count);
  const Resampler resampler(motion, bounds);
  for (std::size_t k = 0; k < count; ++k) {
    resampled.postures.push_back(resampler.At(std::min(static_cast<double>(k) * step, last)));
  }
  return resampled;
}

}  // namespace mmm_converter
