// SPDX-License-Identifier: MIT
#include "common/pipeline/live/live_labeller.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "common/label/tuning.h"
#include "common/support/error.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr double kLongestJump = 2;  // [s] between frames

}  // namespace

LiveLabeller::LiveLabeller(const TrackingSetup& setup, bool waits)
    : body_(std::make_shared<const LabelBody>(setup)), waits_(waits) {
  if (body_->num_markers() < BodyLimits::kFewestMarkers) {
    throw Error(
        fmt::format("a body with {} markers can't be found among points; at least {} are needed",
                    body_->num_markers(), BodyLimits::kFewestMarkers));
  }
  for (const MarkerAssignment& assignment : setup.assignments()) {
    columns_.push_back(assignment.label);
  }
}

void LiveLabeller::Use(const TrackingSetup& setup) {
  body_ = std::make_shared<const LabelBody>(setup);
  search_.Drop();
  if (!following_) return;
  BodyMatch match;
  match.posture = following_->tracker.belief().posture;
  following_ = std::make_unique<BodyTracker>(body_);
  following_->tracker.Start(match);
}

void LiveLabeller::Collect(const StreamFrame& frame) {
  cloud_.time = frame.time;
  cloud_.count = 0;
  const auto add = [this](const auto& points) {
    for (Eigen::Index i = 0; i < points.cols() && cloud_.count < PointCloud::kMost; ++i) {
      if (points.col(i).allFinite()) cloud_.points.col(cloud_.count++) = points.col(i);
    }
  };
  add(frame.points);
  add(frame.unnamed_points.leftCols(frame.unnamed));
}

void LiveLabeller::Forget() {
  following_.reset();
  search_.Drop();
}

void LiveLabeller::TakeFound(double time) {
  std::optional<LabelSearch::Found> found = search_.Take();
  if (!found || found->time >= time || time - found->time > kLongestJump) return;
  following_ = std::move(found->body);
  followed_time_ = found->time;
  is_look_due_ = false;
  watch_.Restart();
}

void LiveLabeller::Follow(Eigen::Matrix3Xd* named) {
  const double dt = cloud_.time - followed_time_;
  const std::vector<int>& points = following_->tracker.Track(cloud_.seen(), dt);
  followed_time_ = cloud_.time;
  int found = 0;
  for (std::size_t m = 0; m < points.size(); ++m) {
    if (points[m] < 0) continue;
    named->col(columns_[m]) = cloud_.points.col(points[m]);
    ++found;
  }
  watch_.Count(found, cloud_.count, body_->num_markers(), dt);
  is_look_due_ = watch_.IsLookDue(dt) || is_look_due_;
  if (watch_.IsLost()) Forget();
}

void LiveLabeller::AskForSearch() {
  if (search_.is_running() || cloud_.count < BodyLimits::kFewestMarkers) return;
  if (!following_) {
    search_.Begin(body_, nullptr);
  } else if (std::exchange(is_look_due_, false)) {
    search_.Begin(body_, &following_->tracker.belief().posture);
  }
}

void LiveLabeller::Name(const StreamFrame& frame, Eigen::Matrix3Xd* named) {
  named->setConstant(kNaN);
  const double last = std::exchange(cloud_.time, frame.time);
  Collect(frame);
  if (waits_) search_.Wait();
  if (frame.time <= last || frame.time - last > kLongestJump) Forget();
  TakeFound(frame.time);
  if (following_) Follow(named);
  search_.Remember(cloud_);
  AskForSearch();
}

}  // namespace mmm_converter
