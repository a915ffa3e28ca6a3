// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "common/convert/tracking_setup.h"
#include "common/live/frame_source.h"
#include "common/pipeline/live/label_search.h"

namespace mmm_converter {

/// Names the points of a stream, frame by frame, by the body that wears them: those that the source
/// has labels for and those without alike. The body is looked for on another thread, while frames
/// go on without names; while it is followed, that thread looks once a second whether another
/// posture explains the points better. For one thread.
class LiveLabeller {
 public:
  /// setup: as LabelRecording's; its labels are columns of what is named. waits: frames wait for
  /// the search, so that the names are the same at each run; for replays as fast as possible.
  /// @throws Error where the setup has too few markers.
  LiveLabeller(const TrackingSetup& setup, bool waits);

  /// *named: 3 x names [m], has its size; NaN: no point has the name.
  void Name(const StreamFrame& frame, Eigen::Matrix3Xd* named);

  /// The same markers on another body, from the next frame on (a calibrated person's).
  void Use(const TrackingSetup& setup);

  bool is_following() const { return following_ != nullptr; }

 private:
  void Collect(const StreamFrame& frame);
  void TakeFound(double time);
  void Follow(Eigen::Matrix3Xd* named);
  void Forget();
  void AskForSearch();

  std::shared_ptr<const LabelBody> body_;
  std::vector<int> columns_;  // by marker
  bool waits_;
  PointCloud cloud_;
  std::unique_ptr<BodyTracker> following_;
  double followed_time_ = 0;  // of the last cloud that it has seen [s]
  BodyWatch watch_ = BodyWatch(WatchTuning::kLive);
  bool is_look_due_ = false;  // for another posture, since the last one
  LabelSearch search_;
};

}  // namespace mmm_converter
