// SPDX-License-Identifier: MIT
#include "common/pipeline/live/label_search.h"

#include <algorithm>
#include <utility>

#include "common/label/search/body_search.h"
#include "common/label/tuning.h"
#include "common/live/any_processor.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kRemembered = 64;  // clouds: 0.6 s of 100 Hz
constexpr int kMostFrames = 3;           // that a body is looked for in, one after the other
constexpr double kGoodCost = 1;          // of a marker: a ninth of what it costs without a point

}  // namespace

LabelSearch::LabelSearch() : clouds_(kRemembered), thread_([this] { Run(); }) {}

LabelSearch::~LabelSearch() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void LabelSearch::Remember(const PointCloud& cloud) {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return;
  PointCloud& place = clouds_[static_cast<std::size_t>(num_clouds_) % kRemembered];
  place.time = cloud.time;
  place.count = cloud.count;
  place.points.leftCols(cloud.count) = cloud.seen();
  ++num_clouds_;
}

void LabelSearch::Begin(std::shared_ptr<const LabelBody> body, const Posture* posture) {
  {
    const std::lock_guard lock(mutex_);  // the other thread waits, and holds nothing
    if (num_clouds_ == 0) return;
    job_.body = std::move(body);
    job_.posture.reset();
    if (posture != nullptr) job_.posture = *posture;
    found_.reset();
    is_dropped_ = false;
    is_running_.store(true, std::memory_order_release);
  }
  changed_.notify_all();
}

void LabelSearch::Wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !is_running_.load(); });
}

std::optional<LabelSearch::Found> LabelSearch::Take() {
  if (is_running()) return std::nullopt;
  std::optional<Found> found = std::exchange(found_, std::nullopt);
  if (std::exchange(is_dropped_, false)) found.reset();
  return found;
}

std::int64_t LabelSearch::Newest(PointCloud* cloud) {
  const std::lock_guard lock(mutex_);
  *cloud = clouds_[static_cast<std::size_t>(num_clouds_ - 1) % kRemembered];
  return num_clouds_ - 1;
}

bool LabelSearch::Next(std::int64_t* number, PointCloud* cloud) {
  const std::lock_guard lock(mutex_);
  const auto oldest = num_clouds_ - static_cast<std::int64_t>(kRemembered);
  *number = std::max(*number + 1, oldest);
  if (*number >= num_clouds_) return false;
  *cloud = clouds_[static_cast<std::size_t>(*number) % kRemembered];
  return true;
}

LabelSearch::Found LabelSearch::Follow(const Job& job, const BodyMatch& match,
                                       std::int64_t number) {
  constexpr int kMostSteps = 2 * static_cast<int>(kRemembered);  // where frames come faster
  Found found{std::make_unique<BodyTracker>(job.body), 0};
  LabelTracker& tracker = found.body->tracker;
  tracker.Start(match);
  PointCloud cloud;
  --number;
  for (int i = 0; i < kMostSteps && Next(&number, &cloud); ++i) {
    if (i > 0) tracker.Track(cloud.seen(), cloud.time - found.time);
    found.time = cloud.time;
  }
  return found;
}

std::optional<LabelSearch::Found> LabelSearch::Search(const Job& job) {
  BodySearch search(*job.body);
  const int markers = job.body->num_markers();
  PointCloud cloud;
  std::int64_t number = -1, best_number = -1;
  BodyMatch best;
  for (int i = 0; i < kMostFrames; ++i) {
    const std::int64_t last = std::exchange(number, Newest(&cloud));
    if (number == last) break;
    BodyMatch match = search.Find(cloud.seen());
    if (best_number >= 0 && match.cost >= best.cost) continue;
    best = std::move(match);
    best_number = number;
    if (best.cost < kGoodCost * markers) break;
  }
  if (2 * best.matched < markers) return std::nullopt;
  return Follow(job, best, best_number);
}

std::optional<LabelSearch::Found> LabelSearch::LookAnywhere(const Job& job) {
  BodySearch search(*job.body);
  PointCloud cloud;
  const std::int64_t number = Newest(&cloud);
  const BodyMatch other = search.Find(cloud.seen());
  BodyMatch own = search.Match(cloud.seen(), *job.posture);
  BodyMatch near = search.FindNear(cloud.seen(), *job.posture, TrackTuning::kNearby);
  if (near.cost < own.cost) own = std::move(near);
  int others = 0;
  for (std::size_t m = 0; m < own.point_of_marker.size(); ++m) {
    if (own.point_of_marker[m] != other.point_of_marker[m]) ++others;
  }
  if (!watch_.IsReplaced(own.cost, other.cost, others)) return std::nullopt;
  return Follow(job, other, number);
}

void LabelSearch::Run() {
  UseAnyProcessor();
  while (true) {
    Job job;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return is_ending_ || is_running_.load(); });
      if (is_ending_) return;
      job = std::move(job_);
    }
    std::optional<Found> found = job.posture ? LookAnywhere(job) : Search(job);
    {
      const std::lock_guard lock(mutex_);
      found_ = std::move(found);
      is_running_.store(false, std::memory_order_release);
    }
    changed_.notify_all();
  }
}

}  // namespace mmm_converter
