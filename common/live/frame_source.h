// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace mmm_converter {

using SteadyTime = std::chrono::steady_clock::time_point;

/// What the frames of a stream have, until the source says that this has changed.
struct StreamLayout {
  std::string source;               ///< for messages: "QTM 2.3 (build 464), protocol 1.25"
  std::vector<std::string> labels;  ///< of the columns of StreamFrame::points
  double rate = 0;                  ///< [Hz]; 0: the source does not say
};

struct StreamFrame {
  std::int64_t number = 0;          ///< the source's own
  double time = 0;                  ///< by the source's clock [s]
  SteadyTime received;              ///< when its last byte was there
  Eigen::Matrix3Xd points;          ///< 3 x labels [m], z up; NaN: not seen
  int unnamed = 0;                  ///< points that the source has no name for
  Eigen::Matrix3Xd unnamed_points;  ///< 3 x at least as many [m], z up: these come first
};

/// Of a frame; there may be noise of a hall full of reflections, and hostile servers.
inline constexpr int kMostUnnamed = 1000;

/// Makes room for so many points without a name, at most kMostUnnamed; memory is used again.
void SetUnnamed(std::size_t count, StreamFrame* frame);

/// What a source counts while it runs.
struct StreamCounts {
  std::int64_t frames = 0;
  std::int64_t lost = 0;         ///< frames that never came, by the source's numbers
  std::int64_t broken = 0;       ///< messages that are not as the protocol says; left out
  std::int64_t connections = 0;  ///< 1 + how often the source was connected to again
};

enum class StreamEvent {
  kFrame,    ///< *frame has the next frame
  kNothing,  ///< none came in time
  kLayout,   ///< layout() is new; comes before the first frame, and after each connection
  kLost,     ///< no connection any more, said once: message() has the reason; Next goes on trying
  kEnd,      ///< the source ended for good
};

/// A stream of frames with named points, such as a motion capture system. For one thread.
class FrameSource {
 public:
  virtual ~FrameSource();

  /// Goes on, for at most about `wait`: connects, where there is no connection (again and again,
  /// with growing waits between), and reads. *frame is filled with kFrame only; once it has its
  /// size nothing is allocated.
  /// @throws Error for what waiting does not mend: an address without a server at the first
  /// attempt, a refused version or password, a stream without labels where these are needed.
  virtual StreamEvent Next(std::chrono::milliseconds wait, StreamFrame* frame) = 0;

  /// Valid from the first kLayout on.
  virtual const StreamLayout& layout() const = 0;
  /// Of the last kLost or kEnd: a sentence.
  virtual const std::string& message() const = 0;
  virtual const StreamCounts& counts() const = 0;

  /// Whether each frame has to be taken before the source goes on (a file that is played as fast as
  /// possible). Of others the newest frame counts.
  virtual bool waits_for_reader() const { return false; }
};

}  // namespace mmm_converter
