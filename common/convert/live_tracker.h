// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <memory>

#include "common/convert/motion_converter.h"
#include "common/convert/tracking_start.h"

namespace mmm_converter {

/// Longest time without a frame, or without three seen markers, that is predicted through [s].
inline constexpr double kLongestGap = 2;

/// A converter that follows a stream: it waits until a person is seen (TrackingStart), predicts
/// through short gaps, and starts anew after long ones and where the source's time runs back. On
/// the frames of a recording without long gaps it gives what MotionConverter::Convert gives from
/// its first assembled frame on.
class LiveTracker {
 public:
  /// rate: of the source [Hz]; steps of time that are its multiples but for rounding are taken as
  /// these. 0: not known.
  LiveTracker(std::unique_ptr<MotionConverter> converter, double rate);

  const TrackingSetup& setup() const { return converter_->setup(); }

  /// points: 3 x labels of the setup [m]; time: the frame's own [s], which drives the motion model.
  /// Null: the person is waited for. The estimate is valid until the next call; tracking allocates
  /// nothing.
  const FrameEstimate* Track(const Eigen::Ref<const Eigen::Matrix3Xd>& points, double time);

  /// After a frame has gone out: does what does not need the next one, one step of the source's
  /// rate later. Changes no estimate.
  void Prepare();

  /// The next frame starts anew.
  void Restart() { is_tracking_ = false; }

  bool is_tracking() const { return is_tracking_; }
  int starts() const { return starts_; }  ///< how often a track began

 private:
  double StepTo(double time) const;
  bool IsOver(double time, int seen);

  std::unique_ptr<MotionConverter> converter_;
  double rate_;
  TrackingStart start_;
  bool is_tracking_ = false;
  double time_ = 0;       // of the last frame
  double seen_time_ = 0;  // of the last frame that showed enough markers
  int starts_ = 0;
};

}  // namespace mmm_converter
