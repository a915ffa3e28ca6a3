// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "common/live/frame_source.h"

namespace mmm_converter {

/// A source at the other end of a connection: when it is tried again after a loss, what is said of
/// it, and what is counted. How it is connected to and read is the protocol's.
class ConnectedSource : public FrameSource {
 public:
  StreamEvent Next(std::chrono::milliseconds wait, StreamFrame* frame) final;
  const StreamLayout& layout() const final { return layout_; }
  const std::string& message() const final { return message_; }
  const StreamCounts& counts() const final { return counts_; }

 protected:
  using Event = std::optional<StreamEvent>;

  /// now: the time that limits and retries count by.
  explicit ConnectedSource(std::function<SteadyTime()> now);

  // The protocol's.
  virtual Event Connect() = 0;                      ///< begins to
  virtual Event Advance(StreamFrame* frame) = 0;    ///< reads what is there
  virtual Event FillFrame(StreamFrame* frame) = 0;  ///< of the message that FrameCame was said of
  virtual void Wait(std::chrono::nanoseconds most) = 0;  ///< until there is something to read
  virtual void Disconnect() = 0;
  virtual std::string Server() const = 0;  ///< for messages

  SteadyTime now() const { return now_(); }
  bool is_connected() const { return is_connected_; }  ///< or about to be

  /// The server has answered; its frames' numbers may begin anew.
  void CountConnection();
  void CountBroken() { ++counts_.broken; }
  /// Of a frame that was filled: those before it that never came. What comes late is not counted
  /// twice; numbers that begin anew are followed.
  StreamEvent CountFrame(std::int64_t number);

  /// Ends the connection, which is tried again later; kLost where that has not been said yet.
  /// @throws Error where there never was a layout.
  Event Lose(const std::string& reason, const std::string& remedy = "");
  /// That no frames come, which is said once until they come again.
  Event Say(const std::string& reason);
  /// Ends the connection to begin another at once.
  void ConnectAnew();

  /// kLayout where it is new, unless it is said before the next frame anyway. One of too many
  /// labels ends the connection as Lose.
  Event TakeLayout(StreamLayout layout);
  /// FillFrame, where the layout need not be said before.
  Event FrameCame(StreamFrame* frame);

 private:
  std::function<SteadyTime()> now_;
  bool is_connected_ = false;
  SteadyTime retry_at_;
  std::chrono::milliseconds retry_wait_;
  StreamLayout layout_;
  bool had_layout_ = false;
  bool is_lost_ = false;           // which has been said
  bool layout_is_due_ = false;     // before the next frame
  bool frame_is_pending_ = false;  // kLayout was said before it
  std::int64_t last_number_ = -1;
  std::string message_;
  StreamCounts counts_;
};

}  // namespace mmm_converter
