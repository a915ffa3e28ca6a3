// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/live/live_run.h"

#include <fmt/format.h>

#include <chrono>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "MMMConverterS2KF/live/live_output.h"
#include "MMMConverterS2KF/live/live_sinks.h"
#include "MMMConverterS2KF/live/web_sink.h"
#include "common/live/realtime_priority.h"
#include "common/live/sink_runner.h"
#include "common/pipeline/retarget_verdict.h"

namespace mmm_converter {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kWait(100);
constexpr int kFileCapacity = 4096;  // frames: 20 s of 200 Hz, while a disk stands
constexpr int kNetworkCapacity = 64;
constexpr int kAllBodies = -1;

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

class LiveRun {
 public:
  LiveRun(const LiveRequest& request, const LiveObserver& observer)
      : request_(request),
        observer_(observer),
        output_(request),
        bodies_(1 + request.other_objects.size()),
        journals_(bodies_.size(), -1),
        stream_(
            request, Open(request, observer),
            [this](const auto& body, const auto& pose) { Give(body, pose); },
            [this](bool is_warning, std::string text) { news_.Add(is_warning, std::move(text)); }) {
    output_.CheckFiles();  // a robot is read by now, and what it names
    report_.objects.resize(bodies_.size() - 1);
    {
      // Threads of sinks begin with it.
      const RealtimePriority priority(request.realtime ? kTrackingPriority - 1 : 0, true);
      for (const std::string& address : request.sinks) {
        AddSink(OpenSink(address), kNetworkCapacity, TakesObjects(address) ? kAllBodies : 0);
      }
    }
    if (!request.view) return;
    LivePage page = OpenLivePage(request.view_address, "Live: " + request.input.file);
    AddSink(std::move(page.sink), kNetworkCapacity, kAllBodies);
    news_.Add(false, "to watch it, open " + page.address);
  }

  LiveReport Run() {
    const auto start = steady_clock::now();
    stream_.Start();
    const auto is_over = [&] {
      const std::chrono::duration<double> seconds = steady_clock::now() - start;
      return (request_.longest > 0 && seconds.count() > request_.longest) ||
             (observer_.is_over && observer_.is_over());
    };
    while (!stream_.has_ended()) {
      std::this_thread::sleep_for(kWait);
      news_.Tell(observer_);
      if (observer_.status) observer_.status(stream_.status());
      if (is_over()) stream_.Stop();
    }
    stream_.Join();
    report_.seconds = std::chrono::duration<double>(steady_clock::now() - start).count();
    Finish();
    return std::move(report_);
  }

 private:
  static LiveSource Open(const LiveRequest& request, const LiveObserver& observer) {
    Warnings warnings;
    LiveSource source = OpenSourceOf(request, &warnings);
    for (const std::string& text : warnings.texts()) observer.warning(text);
    return source;
  }

  // body: the index of the one that the sink gets, or kAllBodies.
  void AddSink(std::unique_ptr<PoseSink> sink, int capacity, int body) {
    const std::string name = sink->name();
    const std::size_t index = sinks_.size();
    {
      const std::lock_guard lock(failures_mutex_);  // sinks that run may write theirs
      failures_.emplace_back();
    }
    bodies_of_sinks_.push_back(body);
    sinks_.push_back(std::make_unique<SinkRunner>(
        std::move(sink), capacity, [this, name, index](const std::string& why) {
          news_.Add(true, fmt::format("{}: {}; it gets no more frames", name, why));
          const std::lock_guard lock(failures_mutex_);
          failures_[index] = why;
        }));
  }

  void Give(const std::shared_ptr<const LiveBody>& body, const PoseFrame& pose) {
    if (body != bodies_[static_cast<std::size_t>(body->index)]) TakeBody(body);
    if (body->index > 0) {
      OtherObject& object = report_.objects[static_cast<std::size_t>(body->index - 1)];
      if (pose.is_tracking) ++object.tracked;
    } else if (pose.is_tracking && !pose.is_held) {
      ++report_.tracked;
      report_.waits.Add(std::chrono::duration<double>(stream_.taken() - pose.received).count());
      report_.delays.Add(std::chrono::duration<double>(pose.tracked - pose.received).count());
    }
    const bool may_wait = stream_.waits_for_reader();
    for (std::size_t i = 0; i < sinks_.size(); ++i) {
      const bool takes_it = bodies_of_sinks_[i] == kAllBodies || bodies_of_sinks_[i] == body->index;
      if (takes_it) sinks_[i]->Offer(body, pose, may_wait);
    }
  }

  // Another person or other labels begin another motion, a calibration does not.
  void TakeBody(const std::shared_ptr<const LiveBody>& body) {
    const auto index = static_cast<std::size_t>(body->index);
    const auto before = std::exchange(bodies_[index], body);
    const bool goes_on = before && body->labels == before->labels && body->is_calibrated;
    if (index > 0) report_.objects[index - 1].name = body->name;
    if (request_.output.empty()) return;
    const ConversionPlan& plan = stream_.session(body->index).plan();
    if (goes_on) {
      output_.Update(plan, body->index);
      return;
    }
    int& journal = journals_[index];
    if (journal >= 0) sinks_[static_cast<std::size_t>(journal)]->Finish();
    journal = static_cast<int>(sinks_.size());
    AddSink(output_.Begin(plan, *body), kFileCapacity, body->index);
  }

  void Finish() {
    for (const auto& sink : sinks_) sink->Finish();
    news_.Tell(observer_);
    for (std::size_t i = 0; i < sinks_.size(); ++i) {
      report_.sinks.push_back({sinks_[i]->sink().name(), sinks_[i]->written(), sinks_[i]->lost(),
                               sinks_[i]->delays(), failures_[i]});
    }
    sinks_.clear();  // journals are closed
    report_.source = stream_.source();
    report_.counts = stream_.counts();
    report_.frames = stream_.status().frames;
    report_.dropped = stream_.status().dropped;
    report_.starts = stream_.session().starts();
    for (std::size_t i = 0; i < report_.objects.size(); ++i) {
      report_.objects[i].starts = stream_.session(static_cast<int>(i) + 1).starts();
    }
    report_.motions = output_.Finish(stream_.session().calibration());
    report_.robot_motions = output_.robot_motions();
    JudgeRobot();
    if (stream_.failure()) std::rethrow_exception(stream_.failure());
  }

  void JudgeRobot() {
    if (stream_.robot() == nullptr) return;
    RetargetFigures figures = stream_.robot()->figures();
    if (figures.num_frames == 0) return;
    report_.robot_verdict = JudgeRetargeting(figures, nullptr);
    const std::string& doubt = stream_.robot()->doubt();
    if (!doubt.empty()) AddDoubt(doubt, &*report_.robot_verdict);
    report_.robot = std::move(figures);
  }

  const LiveRequest& request_;
  const LiveObserver& observer_;
  NewsBox news_;
  LiveOutput output_;
  std::vector<std::unique_ptr<SinkRunner>> sinks_;
  std::vector<int> bodies_of_sinks_;
  std::vector<std::shared_ptr<const LiveBody>> bodies_;
  std::vector<int> journals_;  // of each body, of the sinks: the motion that is being written
  LiveReport report_;
  std::mutex failures_mutex_;
  std::vector<std::string> failures_;  // of the sinks
  LiveStream stream_;                  // the last: its threads use the others
};

}  // namespace

LiveReport TrackLive(const LiveRequest& request, const LiveObserver& observer) {
  LiveRun run(request, observer);
  return run.Run();
}

}  // namespace mmm_converter
