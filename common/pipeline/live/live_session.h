// SPDX-License-Identifier: MIT
#pragma once

#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/convert/live_tracker.h"
#include "common/live/frame_mailbox.h"
#include "common/live/pose_frame.h"
#include "common/live/stream_clock.h"
#include "common/pipeline/live/live_bodies.h"
#include "common/pipeline/live/live_labeller.h"
#include "common/pipeline/live_plan.h"
#include "common/pipeline/live_request.h"

namespace mmm_converter {

/// What the session is at.
enum class LiveStage {
  kMeasuring,   ///< frames are gathered that tell the height, or where names of labels are worn
  kWaiting,     ///< for a person
  kTracking,    ///< of a person that is known, or of one that will not be calibrated
  kGathering,   ///< tracking; frames are gathered for the calibration
  kCalibrating  ///< tracking; the person is being estimated in the background
};

/// The work of the tracking thread: from a stream's frames to postures of a person who may not be
/// known yet, be calibrated meanwhile, leave and return.
class LiveSession {
 public:
  /// head: what is known of the stream beyond its frames, without markers; played: of a replay all
  /// frames. index: which of `count` bodies it is. waits: as of LiveLabeller.
  LiveSession(LiveBodyRequest body, int index, int count, const Recording& head,
              const MarkerSequence& played, bool waits);

  /// @throws Error where the labels or the person are not known; ends the session.
  const PoseFrame& Take(const LaidOutFrame& frame, std::int64_t dropped);

  /// While no frame waits: what the next one can do without. Changes no posture.
  void Prepare();

  /// Null: not known yet.
  const std::shared_ptr<const LiveBody>& body() const { return body_; }
  /// With the calibrated person, once there is one. Only where there is a body.
  const ConversionPlan& plan() const { return *plan_; }
  const std::optional<CalibrationResult>& calibration() const { return calibration_; }
  LiveStage stage() const { return stage_; }
  const char* stage_text() const;
  double gathered() const;  ///< share of the frames that the calibration or the height needs
  int starts() const { return starts_ + (tracker_ ? tracker_->starts() : 0); }

  /// What there is to say since the last call, line by line.
  std::vector<std::string> TakeNews();

 private:
  void Begin(const StreamLayout& layout);
  bool TryToPlan(bool is_last_try);
  void CheckName(const std::string& name) const;
  void NamePoints();
  void Use(TrackingSetup setup, bool is_calibrated, std::unique_ptr<MotionConverter> converter);
  void TakePoints(const LaidOutFrame& frame, bool is_new);
  void Track();
  void Gather();
  void GoOnCalibrating();
  void Calibrate();
  void TakeCalibration();
  std::string Who() const;
  void Say(std::string text) { news_.push_back(std::move(text)); }

  LiveRequest request_;
  ChooseLabels choose_;  // empty: all labels are the body's
  std::vector<std::string> other_names_;
  int index_, count_;  // of the stream's bodies
  Recording head_;
  // Of a replay, whose file tells the person as in a conversion; else empty.
  MarkerSequence played_;
  bool waits_;
  std::shared_ptr<const StreamLayout> layout_;
  std::vector<int> columns_;  // of the layout's labels those that count
  std::optional<ConversionPlan> plan_;
  std::shared_ptr<const LiveBody> body_;
  std::unique_ptr<LiveTracker> tracker_;
  std::optional<FoundLabels> labels_;       // the plan's; nothing: labels are the source's
  std::unique_ptr<LiveLabeller> labeller_;  // of these
  StreamClock clock_;
  StreamFrame frame_;  // the columns that count
  PoseFrame pose_;
  LiveStage stage_ = LiveStage::kMeasuring;
  int starts_ = 0;  // of trackers before

  MarkerSequence gathered_;
  int num_gathered_ = 0;
  double calibration_time_;
  struct Calibrated {
    LiveCalibration person;
    std::unique_ptr<MotionConverter> converter;
  };
  std::future<Calibrated> calibrated_;
  std::optional<CalibrationResult> calibration_;
  std::vector<std::string> news_;
};

}  // namespace mmm_converter
