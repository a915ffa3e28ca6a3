// SPDX-License-Identifier: MIT
#include "common/live/stream_clock.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace mmm_converter {
namespace {

// [s] Frames may come out of order, and late; a clock that goes back further, or after a longer
// silence, begins anew.
constexpr double kOutOfOrder = 0.5;
// [s] The time that a new connection's clock may differ from its frames' arrival.
constexpr double kSameClock = 1;
constexpr double kUsualStep = 0.01;  // [s] of a stream that states no rate

}  // namespace

double StreamClock::Take(double source_time, SteadyTime received, double rate, bool is_new) {
  double time = source_time + shift_;
  outage_ = 0;
  if (has_begun_) {
    const double passed = std::chrono::duration<double>(received - received_).count();
    const double by_source = time - last_;
    const bool is_another = is_new && std::abs(by_source - passed) > kSameClock;
    const bool goes_back = by_source <= 0 && std::max(-by_source, passed) > kOutOfOrder;
    if (goes_back || is_another) {
      outage_ = std::max(passed, rate > 0 ? 1 / rate : kUsualStep);
      time = last_ + outage_;
      shift_ = time - source_time;
    }
  }
  last_ = has_begun_ ? std::max(last_, time) : time;
  has_begun_ = true;
  received_ = received;
  return time;
}

}  // namespace mmm_converter
