// SPDX-License-Identifier: MIT
#include "common/pipeline/live/live_stream.h"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "common/live/realtime_priority.h"

namespace mmm_converter {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::steady_clock;

constexpr milliseconds kWait(100);
constexpr int kMostMadeUp = 2 * FrameMailbox::kRoom;
constexpr std::chrono::microseconds kPolled(200);  // before and after a frame is due
constexpr double kBusyShare = 0.05;                // of a frame in the mean of how long one takes

}  // namespace

LiveSource OpenSourceOf(const LiveRequest& request, Warnings* warnings) {
  SourceOptions options;
  options.needs_labels = !request.label;
  options.reading = request.input.reading;
  options.reading.with_unlabelled = request.label;
  options.reading.all_subjects = !request.other_objects.empty();
  options.loops = request.loops;
  return OpenLiveSource(request.input.file, options, warnings);
}

LiveStream::LiveStream(const LiveRequest& request, LiveSource source, Give give, Tell tell)
    : request_(request),
      give_(std::move(give)),
      tell_(std::move(tell)),
      live_(std::move(source)),
      mailbox_(live_.source->waits_for_reader()) {
  const MarkerSequence played = std::exchange(live_.head.markers, {});
  std::vector<LiveBodyRequest> bodies = BodiesOf(request, live_.selects_labels);
  const int count = static_cast<int>(bodies.size());
  for (int i = 0; i < count; ++i) {
    sessions_.push_back(
        std::make_unique<LiveSession>(std::move(bodies[static_cast<std::size_t>(i)]), i, count,
                                      live_.head, played, waits_for_reader()));
  }
  if (request.robot.file.empty()) return;
  Warnings warnings;
  robot_ = std::make_unique<LiveRobot>(request.robot, request.follow, &warnings);
  for (const std::string& text : warnings.texts()) tell_(true, text);
}

LiveStream::~LiveStream() {
  Stop();
  Join();
}

void LiveStream::Start() {
  reader_ = std::thread([this] { Guard([this] { Read(); }); });
  tracker_ = std::thread([this] { Guard([this] { Track(); }); });
}

void LiveStream::Join() {
  if (reader_.joinable()) reader_.join();
  if (tracker_.joinable()) tracker_.join();
}

LiveStatus LiveStream::status() const {
  return {status_stage_, status_text_, status_frames_, mailbox_.dropped(), status_gathered_};
}

template <typename Work>
void LiveStream::Guard(Work work) {
  try {
    work();
  } catch (...) {
    const std::lock_guard lock(failure_mutex_);
    if (!failure_) failure_ = std::current_exception();
    is_ending_ = true;
  }
  mailbox_.StopWaiting();
  if (++ended_threads_ == 2) has_ended_ = true;
}

void LiveStream::Read() {
  const RealtimePriority priority(request_.realtime ? kTrackingPriority + 1 : 0, false);
  struct Closed {
    FrameMailbox& box;
    ~Closed() { box.Close(); }
  } const closed{mailbox_};
  std::shared_ptr<const StreamLayout> layout;
  bool is_lost = false, has_broken = false;
  while (!is_ending_) {
    LaidOutFrame& slot = mailbox_.next();
    const StreamEvent event = live_.source->Next(kWait, &slot.frame);
    if (!has_broken && live_.source->counts().broken > 0) {
      has_broken = true;
      tell_(true,
            "a message that is not as the protocol says was left out; others are only counted");
    }
    switch (event) {
      case StreamEvent::kFrame:
        slot.layout = layout;
        slot.counts = live_.source->counts();
        mailbox_.Put();
        break;
      case StreamEvent::kLayout:
        layout = std::make_shared<const StreamLayout>(live_.source->layout());
        if (is_lost) tell_(false, fmt::format("{}: frames come again", layout->source));
        is_lost = false;
        break;
      case StreamEvent::kLost:
        is_lost = true;
        tell_(true, live_.source->message());
        break;
      case StreamEvent::kEnd:
        tell_(false, live_.source->message());
        return;
      case StreamEvent::kNothing:
        break;
    }
  }
}

void LiveStream::Track() {
  ChooseProcessor();
  const RealtimePriority priority(request_.realtime ? kTrackingPriority : 0, false);
  polls_ = priority.is_given();
  if (request_.realtime && !polls_) {
    tell_(true, fmt::format("no real-time priority: {}; the user needs the right to it (rtprio "
                            "in /etc/security/limits.conf)",
                            std::strerror(errno)));
  }
  while (!is_ending_) {
    const LaidOutFrame* frame = NextFrame();
    if (frame == nullptr) {
      if (mailbox_.is_closed() && mailbox_.is_empty()) return;
      continue;
    }
    const int starts = this->starts();
    taken_ = steady_clock::now();
    NameDropped(frame->frame.number);
    for (const auto& session : sessions_) {
      const PoseFrame& pose = session->Take(*frame, mailbox_.dropped());
      for (std::string& text : session->TakeNews()) tell_(false, std::move(text));
      if (session->body()) Pass(*session, pose);
    }
    source_ = frame->layout->source;
    rate_ = frame->layout->rate;
    received_ = frame->frame.received;
    ++status_frames_;
    status_stage_ = session().stage();
    status_text_ = session().stage_text();
    status_gathered_ = session().gathered();
    if (this->starts() != starts) to_make_up_ = kMostMadeUp;
    for (const auto& session : sessions_) {
      if (mailbox_.is_empty()) session->Prepare();
    }
    const std::chrono::duration<double> busy = steady_clock::now() - taken_;
    busy_ += kBusyShare * (busy.count() - busy_);
  }
}

int LiveStream::starts() const {
  int starts = 0;
  for (const auto& session : sessions_) starts += session->starts();
  return starts;
}

void LiveStream::Pass(const LiveSession& session, const PoseFrame& pose) {
  if (!robot_ || session.body()->index > 0) return give_(session.body(), pose);
  robot_->Take(session.body(), pose);
  for (std::string& text : robot_->TakeNews()) tell_(true, std::move(text));
  give_(robot_->body(), robot_->frame());
}

// Those that came before the first was taken, while a first posture was searched for, and while
// what tracks did its first work. Later, as many as are tracked before the next frame is due: of
// a stream that halted they come all at once, and the newest is hardly later for it.
int LiveStream::MostInOrder() {
  if (to_make_up_ > 0) {
    --to_make_up_;
    return FrameMailbox::kRoom;
  }
  if (rate_ <= 0) return FrameMailbox::kRoom;
  return static_cast<int>(std::clamp(1 / (rate_ * busy_), 1.0, 1.0 * FrameMailbox::kRoom));
}

const LaidOutFrame* LiveStream::NextFrame() {
  const int most = MostInOrder();
  if (!polls_ || rate_ <= 0) return mailbox_.Take(kWait, most);
  const auto expected = received_ + nanoseconds(static_cast<std::int64_t>(1e9 / rate_));
  const LaidOutFrame* frame = mailbox_.Take(expected - kPolled - steady_clock::now(), most);
  while (frame == nullptr && steady_clock::now() < expected + kPolled) {
    frame = mailbox_.Take(nanoseconds(0), most);
  }
  return frame != nullptr ? frame : mailbox_.Take(kWait, most);
}

// Once a second at most, so that who drops many is not slowed down by saying so.
void LiveStream::NameDropped(std::int64_t number) {
  const std::int64_t before = std::exchange(number_, number);
  const std::int64_t dropped = mailbox_.dropped();
  if (std::exchange(dropped_, dropped) != dropped) last_gap_ = {before, number};
  const std::int64_t more = dropped - named_dropped_;
  const auto now = steady_clock::now();
  if (more == 0 || now < name_dropped_at_) return;
  tell_(true, fmt::format("{} frame{} dropped for newer ones, the last between {} and {}", more,
                          more == 1 ? "" : "s", last_gap_.first, last_gap_.second));
  named_dropped_ = dropped;
  name_dropped_at_ = now + std::chrono::seconds(1);
}

void LiveStream::ChooseProcessor() {
  if (request_.processor < 0) return;
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<std::size_t>(request_.processor), &set);
  const int failure = pthread_setaffinity_np(pthread_self(), sizeof(set), &set);
  if (failure == 0) return;
  tell_(true, fmt::format("processor {}: {}", request_.processor, std::strerror(failure)));
}

}  // namespace mmm_converter
