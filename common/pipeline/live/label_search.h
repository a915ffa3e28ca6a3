// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "common/label/search/label_body.h"
#include "common/label/track/body_watch.h"
#include "common/label/track/label_tracker.h"

namespace mmm_converter {

/// The points of one frame, whatever the source calls them. Its memory is there from the start.
struct PointCloud {
  static constexpr int kMost = 300;  ///< more are left out

  double time = 0;  ///< by the source's clock [s]
  int count = 0;
  Eigen::Matrix3Xd points{3, kMost};  ///< the first `count` [m], z up, finite

  auto seen() const { return points.leftCols(count); }
};

/// A tracker with what it tracks.
struct BodyTracker {
  explicit BodyTracker(std::shared_ptr<const LabelBody> of) : body(std::move(of)), tracker(*body) {}

  std::shared_ptr<const LabelBody> body;
  LabelTracker tracker;
};

/// Looks for a body in the newest of a stream's clouds, on a thread of its own, and follows it
/// through those that have come since. All functions are for one other thread, and do not wait
/// where nothing else is said.
class LabelSearch {
 public:
  LabelSearch();
  ~LabelSearch();
  LabelSearch(const LabelSearch&) = delete;
  LabelSearch& operator=(const LabelSearch&) = delete;

  /// The last ones are kept; one that comes at a bad moment is not.
  void Remember(const PointCloud& cloud);

  /// Begins a search; not while one is running. posture: the body is thought to be there; another
  /// posture is found only where two searches running explain their points much better. Null: it
  /// is not known where the body is.
  void Begin(std::shared_ptr<const LabelBody> body, const Posture* posture);
  bool is_running() const { return is_running_.load(std::memory_order_acquire); }
  /// Until the search that is running has ended.
  void Wait();
  /// What the search that is running finds is no longer wanted.
  void Drop() { is_dropped_ = true; }

  struct Found {
    std::unique_ptr<BodyTracker> body;
    double time = 0;  ///< of the cloud that it has come to
  };
  /// What the last search has found; nothing where it runs, found nothing or was taken already.
  std::optional<Found> Take();

 private:
  struct Job {
    std::shared_ptr<const LabelBody> body;
    std::optional<Posture> posture;
  };

  void Run();
  std::optional<Found> Search(const Job& job);
  /// For another posture than the job's.
  std::optional<Found> LookAnywhere(const Job& job);
  Found Follow(const Job& job, const BodyMatch& match, std::int64_t number);
  /// A copy of the newest cloud, and its number.
  std::int64_t Newest(PointCloud* cloud);
  /// A copy of a cloud; false where it has not come yet. One that is no longer there is passed
  /// over.
  bool Next(std::int64_t* number, PointCloud* cloud);

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<PointCloud> clouds_;  // a ring
  std::int64_t num_clouds_ = 0;     // that have come
  Job job_;
  std::optional<Found> found_;
  std::atomic<bool> is_running_ = false;
  bool is_ending_ = false;
  bool is_dropped_ = false;  // of the thread that asks
  BodyWatch watch_ = BodyWatch(WatchTuning::kLiveAnywhere);
  std::thread thread_;
};

}  // namespace mmm_converter
