// SPDX-License-Identifier: MIT
#include "common/retarget/human_contacts.h"

#include <algorithm>
#include <cmath>

#include "common/math/statistics.h"

namespace mmm_converter {
namespace {

constexpr double kOnHeight = 0.04, kOffHeight = 0.06;  // [m]
constexpr double kOnSpeed = 0.3, kOffSpeed = 0.5;      // [m/s]
constexpr double kShortest = 0.08;                     // [s]
constexpr double kHalfSpan = 0.02;                     // [s] about a frame, of its speed
constexpr double kStands = 0.1;                        // [m/s]
constexpr double kAboveLowest = 0.06;                  // [m] of heights that tell the level

Eigen::Vector3d At(const Eigen::Matrix3Xd& path, double frame) {
  const auto last = static_cast<double>(path.cols() - 1);
  frame = std::clamp(frame, 0.0, last);
  const auto k = static_cast<Eigen::Index>(frame);
  const Eigen::Index next = std::min(k + 1, path.cols() - 1);
  const double part = frame - static_cast<double>(k);
  return (1 - part) * path.col(k) + part * path.col(next);
}

double LevelOf(const Eigen::Matrix3Xd& path, const Eigen::VectorXd& speed) {
  std::vector<double> heights;
  for (Eigen::Index k = 0; k < speed.size(); ++k) {
    if (speed[k] < kStands) heights.push_back(path(2, k));
  }
  if (heights.empty()) return path.cols() > 0 ? path.row(2).minCoeff() : 0;
  std::sort(heights.begin(), heights.end());
  const double low = heights[heights.size() / 10];
  std::erase_if(heights, [&](double height) { return std::abs(height - low) > kAboveLowest; });
  return Median(heights);
}

std::vector<bool> FindOn(const PointState& point, double rate) {
  const auto frames = static_cast<int>(point.height.size());
  std::vector<bool> on(frames, false);
  for (int k = 0; k < frames; ++k) {
    const bool was = k > 0 && on[k - 1];
    const double height = was ? kOffHeight : kOnHeight, speed = was ? kOffSpeed : kOnSpeed;
    on[k] = point.height[k] < height && point.speed[k] < speed;
  }
  const auto each_run = [&](bool value, const auto& change) {
    for (int begin = 0; begin < frames;) {
      int end = begin + 1;
      while (end < frames && on[end] == on[begin]) ++end;
      if (on[begin] == value && end - begin < kShortest * rate) change(begin, end);
      begin = end;
    }
  };
  each_run(false, [&](int begin, int end) {
    const bool is_low = (point.height.segment(begin, end - begin).array() < kOffHeight).all();
    if (begin > 0 && end < frames && is_low) std::fill(on.begin() + begin, on.begin() + end, true);
  });
  // How long those are that the recording cuts off is not known.
  each_run(true, [&](int begin, int end) {
    if (begin > 0 && end < frames) std::fill(on.begin() + begin, on.begin() + end, false);
  });
  return on;
}

}  // namespace

PointState StateOf(const Eigen::Matrix3Xd& path, double rate) {
  PointState state;
  state.height.resize(path.cols());
  state.speed.resize(path.cols());
  const double half = kHalfSpan * rate;
  const auto last = static_cast<double>(path.cols() - 1);
  for (Eigen::Index k = 0; k < path.cols(); ++k) {
    const double before = std::max(0.0, static_cast<double>(k) - half);
    const double after = std::min(last, static_cast<double>(k) + half);
    const double way = (At(path, after) - At(path, before)).norm();
    state.speed[k] = after > before ? way * rate / (after - before) : 0;
  }
  state.level = LevelOf(path, state.speed);
  state.height = path.row(2).transpose().array() - state.level;
  return state;
}

FootStates StatesOf(const HumanMotion& motion) {
  FootStates states;
  for (std::size_t i = 0; i < 2; ++i) {
    states.heels[i] = StateOf(motion.heels[i], motion.rate);
    states.toes[i] = StateOf(motion.toes[i], motion.rate);
  }
  return states;
}

std::array<FootContacts, 2> FindFootContacts(const FootStates& states, double rate) {
  std::array<FootContacts, 2> feet;
  for (std::size_t i = 0; i < 2; ++i) {
    feet[i].heel = FindOn(states.heels[i], rate);
    feet[i].toe = FindOn(states.toes[i], rate);
    bool stands = false;
    for (int k = 0; k < static_cast<int>(feet[i].heel.size()); ++k) {
      const bool on = feet[i].heel[k] || feet[i].toe[k];
      if (on && !stands) feet[i].stances.push_back({k, k});
      if (on) feet[i].stances.back().end = k + 1;
      stands = on;
    }
  }
  return feet;
}

}  // namespace mmm_converter
