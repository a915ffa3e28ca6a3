// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "common/live/frame_mailbox.h"
#include "common/live/pose_frame.h"
#include "common/live/source_address.h"
#include "common/pipeline/live/live_robot.h"
#include "common/pipeline/live/live_session.h"
#include "common/pipeline/live_request.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// The tracking thread's priority under LiveRequest::realtime; the reader's is one above, those of
/// networks one below.
inline constexpr int kTrackingPriority = 20;

/// What a stream is at.
struct LiveStatus {
  LiveStage stage = LiveStage::kMeasuring;
  const char* text = "";     ///< the stage of the first body, in words
  std::int64_t frames = 0;   ///< taken
  std::int64_t dropped = 0;  ///< that a newer one took the place of before they were tracked
  double gathered = 0;       ///< share of the frames that a calibration or the height needs
};

/// The source of a request. @throws Error as OpenLiveSource.
LiveSource OpenSourceOf(const LiveRequest& request, Warnings* warnings);

/// A source that one thread reads and another tracks, from Start on until the source ends or Stop.
class LiveStream {
 public:
  /// Gets each frame of each body once that is known, on the tracking thread: of the person, or of
  /// the robot that follows, and of other objects.
  using Give = std::function<void(const std::shared_ptr<const LiveBody>&, const PoseFrame&)>;
  /// What there is to say, from any thread: whether it is a warning, and a line.
  using Tell = std::function<void(bool, std::string)>;

  /// The request stays valid as long as the stream.
  LiveStream(const LiveRequest& request, LiveSource source, Give give, Tell tell);
  ~LiveStream();

  void Start();
  void Stop() { is_ending_ = true; }                       ///< soon
  const LiveRobot* robot() const { return robot_.get(); }  ///< null: none
  bool has_ended() const { return has_ended_; }
  /// Until both threads have ended.
  void Join();
  LiveStatus status() const;
  bool waits_for_reader() const { return live_.source->waits_for_reader(); }

  // On the tracking thread, or after Join:
  /// Of a body; 0: whom the stream is tracked for.
  const LiveSession& session(int body = 0) const {
    return *sessions_[static_cast<std::size_t>(body)];
  }
  SteadyTime taken() const { return taken_; }  ///< when the tracking thread took the frame
  const std::string& source() const { return source_; }
  // After Join:
  const StreamCounts& counts() const { return live_.source->counts(); }
  const std::exception_ptr& failure() const { return failure_; }

 private:
  template <typename Work>
  void Guard(Work work);
  void Read();
  void Track();
  int starts() const;
  void Pass(const LiveSession& session, const PoseFrame& pose);
  int MostInOrder();
  const LaidOutFrame* NextFrame();
  void NameDropped(std::int64_t number);
  void ChooseProcessor();

  const LiveRequest& request_;
  Give give_;
  Tell tell_;
  LiveSource live_;
  std::vector<std::unique_ptr<LiveSession>> sessions_;
  std::unique_ptr<LiveRobot> robot_;  // null: none
  FrameMailbox mailbox_;
  std::string source_;
  int to_make_up_ = 0;                              // frames
  bool polls_ = false;                              // for a frame that is due
  double rate_ = 0;                                 // of the last frame's source
  double busy_ = 1e-3;                              // with a frame [s], in the mean of some
  SteadyTime received_, taken_;                     // the last frame
  std::int64_t number_ = 0;                         // the last frame's
  std::int64_t dropped_ = 0, named_dropped_ = 0;    // frames
  std::pair<std::int64_t, std::int64_t> last_gap_;  // numbers before and after what was dropped
  SteadyTime name_dropped_at_;                      // not before
  std::mutex failure_mutex_;
  std::exception_ptr failure_;
  std::atomic<bool> is_ending_ = false, has_ended_ = false;
  std::atomic<int> ended_threads_ = 0;
  std::atomic<std::int64_t> status_frames_ = 0;
  std::atomic<LiveStage> status_stage_ = LiveStage::kMeasuring;
  std::atomic<const char*> status_text_ = "waiting for frames";
  std::atomic<double> status_gathered_ = 0;
  std::thread reader_, tracker_;
};

}  // namespace mmm_converter
