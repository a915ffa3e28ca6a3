// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "common/motion/foot_motion.h"
#include "common/motion/foot_states.h"

namespace mmm_converter {

/// Times in which each foot is low and slow, as frames [begin, end) that need not be whole; what
/// the recording cuts begins at 0 or ends at the number of frames less one.
struct SlowFoot {
  double begin = 0, end = 0;
  /// Frames that its speed takes from the first bound to half of it, and from half of the last.
  double slowing = 0, speeding = 0;
};
using SlowFeet = std::array<std::vector<SlowFoot>, 2>;

SlowFeet FindSlowFeet(const FootMotion& motion);

/// How much later than a foot is slow something happens [s].
struct ContactLag {
  double seconds = 0;
  double deviation = 0;
  double share = 0;          ///< of the time in which the speed changes, on top of seconds
  bool is_measured = false;  ///< the deviation, by plates that recorded this person

  double SecondsOf(double change_time) const {
    // [s] Feet that come down from a handstand slow down for longer and are loaded no later.
    constexpr double kLongest = 0.03;
    return seconds + share * std::min(change_time, kLongest);
  }
  /// A foot whose speed changes slowly tells the event as badly, for all that others did.
  double DeviationOf(double change_time) const {
    return is_measured ? deviation : std::max(deviation, change_time);
  }
};
// Of walks that plates recorded: how much later the load begins and ends than a foot is slow, and
// how much that differs at least from event to event.
// A foot that stops at once is loaded sooner.
inline constexpr ContactLag kBeginLag = {0, 0.03, 0.7};  // 31 ms rms of 39 strikes
inline constexpr ContactLag kEndLag = {0, 0.02};         // 15 ms rms of 41 offs

/// When each foot stands, by the motion alone.
FootContacts FindSlowContacts(const FootMotion& motion);

}  // namespace mmm_converter
