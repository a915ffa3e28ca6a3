// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/live/live_run.h"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "MMMConverterS2KF/live/live_output.h"
#include "MMMConverterS2KF/live/live_sinks.h"
#include "MMMConverterS2KF/live/web_sink.h"
#include "common/live/frame_mailbox.h"
#include "common/live/sink_runner.h"
#include "common/live/source_address.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::steady_clock;

constexpr milliseconds kWait(100);
constexpr int kFileCapacity = 4096;  // frames: 20 s of 200 Hz, while a disk stands
constexpr int kNetworkCapacity = 64;
constexpr int kTrackingPriority = 20;  // the reader's is one above, those of networks one below
constexpr int kMostMadeUp = 2 * FrameMailbox::kRoom;
constexpr std::chrono::microseconds kPolled(200);  // before and after a frame is due
constexpr double kBusyShare = 0.05;                // of a frame in the mean of how long one takes

// What threads have to say, until the caller's thread says it.
class NewsBox {
 public:
  void Add(bool is_warning, std::string text) {
    const std::lock_guard lock(mutex_);
    news_.emplace_back(is_warning, std::move(text));
  }
  void Tell(const LiveObserver& observer) {
    std::vector<std::pair<bool, std::string>> news;
    {
      const std::lock_guard lock(mutex_);
      news.swap(news_);
    }
    for (const auto& [is_warning, text] : news) {
      const auto& tell = is_warning ? observer.warning : observer.news;
      if (tell) tell(text);
    }
  }

 private:
  std::mutex mutex_;
  std::vector<std::pair<bool, std::string>> news_;
};

// Of this thread, as long as it exists.
class RealtimePriority {
 public:
  // priority: 0: as it is. for_children: threads that it starts have it, too.
  RealtimePriority(int priority, bool for_children) {
    if (priority == 0) return;
    sched_param wanted{};
    wanted.sched_priority = priority;
    const int policy = SCHED_FIFO | (for_children ? 0 : SCHED_RESET_ON_FORK);
    is_given_ = ::sched_setscheduler(0, policy, &wanted) == 0;
  }
  ~RealtimePriority() {
    const sched_param usual{};
    if (is_given_) ::sched_setscheduler(0, SCHED_OTHER, &usual);
  }
  RealtimePriority(const RealtimePriority&) = delete;
  RealtimePriority& operator=(const RealtimePriority&) = delete;

  bool is_given() const { return is_given_; }

 private:
  bool is_given_ = false;
};

class LiveRun {
 public:
  LiveRun(const LiveRequest& request, const LiveObserver& observer)
      : request_(request),
        observer_(observer),
        live_(Open(request, observer)),
        output_(request),
        session_(request, live_.head, live_.selects_labels, live_.source->waits_for_reader()),
        mailbox_(live_.source->waits_for_reader()) {
    {
      // Threads of sinks begin with it.
      const RealtimePriority priority(request.realtime ? kTrackingPriority - 1 : 0, true);
      for (const std::string& address : request.sinks) {
        AddSink(OpenSink(address), kNetworkCapacity);
      }
    }
    if (!request.view) return;
    LivePage page = OpenLivePage(request.view_address, "Live: " + request.input.file);
    AddSink(std::move(page.sink), kNetworkCapacity);
    news_.Add(false, "to watch it, open " + page.address);
  }

  LiveReport Run() {
    const auto start = steady_clock::now();
    std::thread reader([this] { Guard([this] { Read(); }); });
    std::thread tracker([this] { Guard([this] { Track(); }); });
    const auto is_over = [&] {
      const std::chrono::duration<double> seconds = steady_clock::now() - start;
      return (request_.longest > 0 && seconds.count() > request_.longest) ||
             (observer_.is_over && observer_.is_over());
    };
    while (!has_ended_.load()) {
      std::this_thread::sleep_for(kWait);
      news_.Tell(observer_);
      if (observer_.status) observer_.status(Status());
      if (is_over()) is_ending_ = true;
    }
    reader.join();
    tracker.join();
    report_.seconds = std::chrono::duration<double>(steady_clock::now() - start).count();
    Finish();
    return std::move(report_);
  }

 private:
  static LiveSource Open(const LiveRequest& request, const LiveObserver& observer) {
    Warnings warnings;
    SourceOptions options;
    options.needs_labels = !request.label;
    options.reading = request.input.reading;
    options.reading.with_unlabelled = request.label;
    options.loops = request.loops;
    LiveSource source = OpenLiveSource(request.input.file, options, &warnings);
    for (const std::string& text : warnings.texts()) observer.warning(text);
    return source;
  }

  void AddSink(std::unique_ptr<PoseSink> sink, int capacity) {
    const std::string name = sink->name();
    const std::size_t index = sinks_.size();
    failures_.emplace_back();
    sinks_.push_back(std::make_unique<SinkRunner>(
        std::move(sink), capacity, [this, name, index](const std::string& why) {
          news_.Add(true, fmt::format("{}: {}; it gets no more frames", name, why));
          const std::lock_guard lock(failures_mutex_);
          failures_[index] = why;
        }));
  }

  template <typename Work>
  void Guard(Work work) {
    try {
      work();
    } catch (...) {
      const std::lock_guard lock(failures_mutex_);
      if (!failure_) failure_ = std::current_exception();
      is_ending_ = true;
    }
    mailbox_.StopWaiting();
    if (++ended_threads_ == 2) has_ended_ = true;
  }

  void Read() {
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
        news_.Add(
            true,
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
          if (is_lost) news_.Add(false, fmt::format("{}: frames come again", layout->source));
          is_lost = false;
          break;
        case StreamEvent::kLost:
          is_lost = true;
          news_.Add(true, live_.source->message());
          break;
        case StreamEvent::kEnd:
          news_.Add(false, live_.source->message());
          return;
        case StreamEvent::kNothing:
          break;
      }
    }
  }

  void Track() {
    ChooseProcessor();
    const RealtimePriority priority(request_.realtime ? kTrackingPriority : 0, false);
    polls_ = priority.is_given();
    if (request_.realtime && !polls_) {
      news_.Add(true,
                fmt::format("no real-time priority: {}; the user needs the right to it (rtprio "
                            "in /etc/security/limits.conf)",
                            std::strerror(errno)));
    }
    while (!is_ending_) {
      const LaidOutFrame* frame = NextFrame();
      if (frame == nullptr) {
        if (mailbox_.is_closed() && mailbox_.is_empty()) return;
        continue;
      }
      const int starts = session_.starts();
      taken_ = steady_clock::now();
      NameDropped(frame->frame.number);
      const PoseFrame& pose = session_.Take(*frame, mailbox_.dropped());
      for (std::string& text : session_.TakeNews()) news_.Add(false, std::move(text));
      report_.source = frame->layout->source;
      rate_ = frame->layout->rate;
      received_ = frame->frame.received;
      ++report_.frames;
      if (session_.body()) Give(pose);
      status_frames_ = report_.frames;
      status_stage_ = session_.stage();
      status_gathered_ = session_.gathered();
      if (session_.starts() != starts) to_make_up_ = kMostMadeUp;
      if (mailbox_.is_empty()) session_.Prepare();
      const std::chrono::duration<double> busy = steady_clock::now() - taken_;
      busy_ += kBusyShare * (busy.count() - busy_);
    }
  }

  // Those that came before the first was taken, while a first posture was searched for, and while
  // what tracks did its first work. Later, as many as are tracked before the next frame is due: of
  // a stream that halted they come all at once, and the newest is hardly later for it.
  int MostInOrder() {
    if (to_make_up_ > 0) {
      --to_make_up_;
      return FrameMailbox::kRoom;
    }
    if (rate_ <= 0) return FrameMailbox::kRoom;
    return static_cast<int>(std::clamp(1 / (rate_ * busy_), 1.0, 1.0 * FrameMailbox::kRoom));
  }

  const LaidOutFrame* NextFrame() {
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
  void NameDropped(std::int64_t number) {
    const std::int64_t before = std::exchange(number_, number);
    const std::int64_t dropped = mailbox_.dropped();
    if (std::exchange(dropped_, dropped) != dropped) last_gap_ = {before, number};
    const std::int64_t more = dropped - named_dropped_;
    const auto now = steady_clock::now();
    if (more == 0 || now < name_dropped_at_) return;
    news_.Add(true, fmt::format("{} frame{} dropped for newer ones, the last between {} and {}",
                                more, more == 1 ? "" : "s", last_gap_.first, last_gap_.second));
    named_dropped_ = dropped;
    name_dropped_at_ = now + std::chrono::seconds(1);
  }

  void Give(const PoseFrame& pose) {
    const auto& body = session_.body();
    if (body != body_) TakeBody(body);
    if (pose.is_tracking) {
      ++report_.tracked;
      report_.waits.Add(std::chrono::duration<double>(taken_ - pose.received).count());
      report_.delays.Add(std::chrono::duration<double>(pose.tracked - pose.received).count());
    }
    const bool may_wait = live_.source->waits_for_reader();
    for (const auto& sink : sinks_) {
      if (sink) sink->Offer(body, pose, may_wait);
    }
  }

  // Another person or other labels begin another motion, a calibration does not.
  void TakeBody(const std::shared_ptr<const LiveBody>& body) {
    const bool goes_on = body_ && body->labels == body_->labels && body->is_calibrated;
    body_ = body;
    if (request_.output.empty()) return;
    if (goes_on) {
      output_.Update(session_.plan());
      return;
    }
    if (journal_ >= 0) sinks_[static_cast<std::size_t>(journal_)]->Finish();
    journal_ = static_cast<int>(sinks_.size());
    AddSink(output_.Begin(session_.plan(), *body), kFileCapacity);
  }

  void ChooseProcessor() {
    if (request_.processor < 0) return;
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<std::size_t>(request_.processor), &set);
    const int failure = pthread_setaffinity_np(pthread_self(), sizeof(set), &set);
    if (failure == 0) return;
    news_.Add(true, fmt::format("processor {}: {}", request_.processor, std::strerror(failure)));
  }

  LiveStatus Status() const {
    return {status_stage_, status_frames_, mailbox_.dropped(), status_gathered_};
  }

  void Finish() {
    for (const auto& sink : sinks_) sink->Finish();
    news_.Tell(observer_);
    for (std::size_t i = 0; i < sinks_.size(); ++i) {
      report_.sinks.push_back({sinks_[i]->sink().name(), sinks_[i]->written(), sinks_[i]->lost(),
                               sinks_[i]->delays(), failures_[i]});
    }
    sinks_.clear();  // journals are closed
    report_.counts = live_.source->counts();
    report_.dropped = mailbox_.dropped();
    report_.starts = session_.starts();
    report_.motions = output_.Finish(session_.calibration());
    if (failure_) std::rethrow_exception(failure_);
  }

  const LiveRequest& request_;
  const LiveObserver& observer_;
  NewsBox news_;
  LiveSource live_;
  LiveOutput output_;
  LiveSession session_;
  FrameMailbox mailbox_;
  std::vector<std::unique_ptr<SinkRunner>> sinks_;
  std::shared_ptr<const LiveBody> body_;
  int to_make_up_ = 0;                              // frames
  bool polls_ = false;                              // for a frame that is due
  double rate_ = 0;                                 // of the last frame's source
  double busy_ = 1e-3;                              // with a frame [s], in the mean of some
  SteadyTime received_, taken_;                     // the last frame
  std::int64_t number_ = 0;                         // the last frame's
  std::int64_t dropped_ = 0, named_dropped_ = 0;    // frames
  std::pair<std::int64_t, std::int64_t> last_gap_;  // numbers before and after what was dropped
  SteadyTime name_dropped_at_;                      // not before
  int journal_ = -1;                                // of the sinks the motion that is being written
  LiveReport report_;
  std::mutex failures_mutex_;
  std::vector<std::string> failures_;  // of the sinks
  std::exception_ptr failure_;
  std::atomic<bool> is_ending_ = false, has_ended_ = false;
  std::atomic<int> ended_threads_ = 0;
  std::atomic<std::int64_t> status_frames_ = 0;
  std::atomic<LiveStage> status_stage_ = LiveStage::kMeasuring;
  std::atomic<double> status_gathered_ = 0;
};

}  // namespace

LiveReport TrackLive(const LiveRequest& request, const LiveObserver& observer) {
  LiveRun run(request, observer);
  return run.Run();
}

}  // namespace mmm_converter
