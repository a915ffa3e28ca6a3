// SPDX-License-Identifier: MIT
#pragma once

#include "common/live/frame_source.h"

namespace mmm_converter {

/// The one time base of a stream whose source may be restarted: the source's own time as long as it
/// goes on, and by the frames' arrival from before to after an outage.
class StreamClock {
 public:
  /// The time [s] of the next frame: that of the source, shifted by the same amount until the next
  /// restart. rate [Hz] of the stream, 0: not known; is_new: it is the first of a new layout.
  double Take(double source_time, SteadyTime received, double rate, bool is_new);

  /// How long nothing came before the frame taken last, where the source was restarted [s]; else 0.
  double outage() const { return outage_; }

 private:
  bool has_begun_ = false;
  double last_ = 0;   // as given out [s]
  double shift_ = 0;  // from the source's time [s]
  double outage_ = 0;
  SteadyTime received_ = {};
};

}  // namespace mmm_converter
