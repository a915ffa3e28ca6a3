// SPDX-License-Identifier: MIT
#pragma once

#include <random>

#include "plugins/s2kf/belief.h"
#include "plugins/s2kf/gate_state.h"
#include "plugins/s2kf/track_watch.h"

namespace mmm_converter::s2kf {

/// All that a track carries from one frame to the next: who goes on from a copy does the same to
/// the last bit. OnlineTracker::Start fills it.
struct TrackState {
  Belief belief;
  GateState gate;
  TrackWatch::State watch;
  std::mt19937 random;  ///< of the restarts in frames in doubt
};

}  // namespace mmm_converter::s2kf
