// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/judge/verdict.h"
#include "common/live/frame_source.h"
#include "common/live/latency_histogram.h"
#include "common/pipeline/conversion.h"
#include "common/pipeline/live/live_stream.h"
#include "common/pipeline/live_request.h"
#include "common/retarget/retarget_figures.h"

namespace mmm_converter {

/// What a sink did.
struct SinkReport {
  std::string name;
  std::int64_t written = 0;
  std::int64_t lost = 0;  ///< for want of room
  LatencyHistogram delays;
  std::string failure;  ///< empty: none
};

/// An object that is tracked beside the stream's first body.
struct OtherObject {
  std::string name;
  std::int64_t tracked = 0;  ///< frames with a pose
  int starts = 0;            ///< how often a track began
};

/// Everything that a summary tells.
struct LiveReport {
  std::string source;  ///< what it says of itself
  StreamCounts counts;
  std::int64_t dropped = 0;  ///< frames that a newer one took the place of before they were tracked
  std::int64_t frames = 0;   ///< taken
  std::int64_t tracked = 0;  ///< of them with a posture
  int starts = 0;            ///< how often a track began
  std::vector<OtherObject> objects;
  double seconds = 0;
  LatencyHistogram waits;   ///< from received to taken by the tracking thread, of those tracked
  LatencyHistogram delays;  ///< from received to tracked
  std::vector<SinkReport> sinks;
  std::vector<ConversionReport> motions;   ///< that were written
  std::vector<std::string> robot_motions;  ///< files
  std::optional<RetargetFigures> robot;    ///< that followed; none: it had no frame
  std::optional<Verdict> robot_verdict;    ///< with the above
};

/// How a caller hears of a run; all on its own thread.
struct LiveObserver {
  std::function<void(const std::string&)> news;
  std::function<void(const std::string&)> warning;
  std::function<void(const LiveStatus&)> status;
  std::function<bool()> is_over;  ///< asked ten times a second: whether to end
};

/// Tracks until the source ends, the request's time is over or the observer wants so; then writes
/// what the request asks for.
/// @throws Error; what was tracked is in the journal then.
LiveReport TrackLive(const LiveRequest& request, const LiveObserver& observer);

}  // namespace mmm_converter
