// SPDX-License-Identifier: MIT
#include "common/pipeline/live/live_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "common/io/recording/marker_labels.h"
#include "common/live/any_processor.h"
#include "common/support/advice.h"
#include "common/support/error.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr double kMeasuredTime = 3;       // [s] of frames that tell the height and the names
constexpr Eigen::Index kFewestSeen = 10;  // markers
constexpr double kUsualRate = 100;        // [Hz] of a source that states none

// Enough to tell a height.
bool ShowsPerson(const StreamFrame& frame) {
  const Eigen::Index seen = frame.points.colwise().sum().array().isFinite().count();
  return seen >= std::min<Eigen::Index>(kFewestSeen, frame.points.cols());
}

MarkerSequence Share(const MarkerSequence& markers, const LabelSelection& selection) {
  MarkerSequence share(selection.labels, markers.num_frames(), markers.rate(),
                       markers.first_time());
  for (int k = 0; k < markers.num_frames(); ++k) {
    for (std::size_t i = 0; i < selection.indices.size(); ++i) {
      share.frame(k).col(static_cast<Eigen::Index>(i)) = markers.frame(k).col(selection.indices[i]);
    }
  }
  return share;
}

int FramesOf(double seconds, double rate) {
  return std::max(1, static_cast<int>(std::lround(seconds * (rate > 0 ? rate : kUsualRate))));
}

}  // namespace

const char* LiveSession::stage_text() const {
  switch (stage_) {
    case LiveStage::kMeasuring:
      return "the person is measured";
    case LiveStage::kWaiting:
      return plan_ && plan_->object ? "waiting for the object" : "waiting for the person";
    case LiveStage::kTracking:
      return "tracking";
    case LiveStage::kGathering:
      return "tracking; move all joints for the calibration";
    case LiveStage::kCalibrating:
      return "tracking; calibrating";
  }
  return "";
}

LiveSession::LiveSession(LiveBodyRequest body, int index, int count, const Recording& head,
                         const MarkerSequence& played, bool waits)
    : request_(std::move(body.request)),
      choose_(std::move(body.choose)),
      other_names_(std::move(body.other_names)),
      index_(index),
      count_(count),
      head_(head),
      waits_(waits),
      calibration_time_(request_.calibration_time) {
  if (request_.label || played.num_frames() == 0) return;
  Warnings told_later;
  played_ = choose_ ? Share(played, choose_(played.labels(), head_.file, &told_later)) : played;
}

double LiveSession::gathered() const {
  return static_cast<double>(num_gathered_) / std::max(1, gathered_.num_frames());
}

std::vector<std::string> LiveSession::TakeNews() { return std::exchange(news_, {}); }

void LiveSession::Begin(const StreamLayout& layout) {
  std::vector<std::string> labels;
  if (!request_.label) labels = layout.labels;
  columns_.resize(labels.size());
  std::iota(columns_.begin(), columns_.end(), 0);
  if (choose_) {
    Warnings warnings;
    LabelSelection selection = choose_(layout.labels, layout.source, &warnings);
    for (const std::string& text : warnings.texts()) Say(text);
    columns_ = selection.indices;
    labels = std::move(selection.labels);
    if (index_ == 0) head_.subject = selection.subject;
  }
  const bool is_same =
      body_ && (request_.label || labels == body_->labels) && layout.rate == body_->rate;
  if (is_same) {
    tracker_->Restart();
    return;
  }
  Say(fmt::format(
      "{}: {}{}", layout.source,
      request_.label ? "points are named by the body" : fmt::format("{} labels", labels.size()),
      layout.rate > 0 ? fmt::format(", {:g} Hz", layout.rate) : ""));
  if (tracker_) starts_ += tracker_->starts();
  tracker_.reset();
  body_.reset();
  calibrated_ = {};
  gathered_ = MarkerSequence(labels, FramesOf(kMeasuredTime, layout.rate),
                             layout.rate > 0 ? layout.rate : kUsualRate, 0);
  num_gathered_ = 0;
  const auto count = static_cast<Eigen::Index>(labels.size());
  frame_.points.setConstant(3, count, kNaN);
  stage_ = LiveStage::kMeasuring;
  TryToPlan(request_.label);
}

void LiveSession::NamePoints() {
  // Summaries tell what was found in a whole recording.
  labels_ = std::exchange(plan_->labels, std::nullopt);
  const std::vector<std::string>& names = labels_->labelling.names;
  gathered_ = MarkerSequence(names, 1, gathered_.rate(), 0);
  frame_.points.setConstant(3, static_cast<Eigen::Index>(names.size()), kNaN);
  labeller_ = std::make_unique<LiveLabeller>(labels_->setup, waits_);
}

// Who takes postures tells bodies apart by their names.
void LiveSession::CheckName(const std::string& name) const {
  for (const std::string& other : other_names_) {
    if (!EqualIgnoringCase(name, other)) continue;
    throw Error(fmt::format(
        "the motion is called {}, and so is the object {} beside it; give {} another name, or "
        "rename the file of the object's model",
        name, other, OptionText("motion")));
  }
}

bool LiveSession::TryToPlan(bool is_last_try) {
  const bool is_played = played_.num_frames() > 0;
  head_.markers = is_played ? played_ : gathered_.Slice(0, std::max(1, num_gathered_));
  try {
    ConversionPlan plan = PlanLive(request_, head_);
    CheckName(plan.motion_name);
    if (plan.input.names && !is_played && !is_last_try) return false;  // frames are to judge them
    plan.input.recording.markers = plan.input.recording.markers.Slice(0, 1);
    plan_ = std::move(plan);
  } catch (const Error& error) {
    if (is_last_try || error.remedy() != Remedy::kHeight) throw;
    return false;
  }
  for (const std::string& text : plan_->warnings.texts()) Say(text);
  if (plan_->person.height_deviation > 0) {
    Say(fmt::format("height: {}", DescribeHeight(plan_->person)));
  }
  if (plan_->labels) NamePoints();
  auto converter = MakeConverter(*plan_, plan_->setup);
  Use(plan_->setup, plan_->person.subject != nullptr, std::move(converter));
  if (calibration_time_ > 0 && !plan_->person.subject) {
    const double rate = gathered_.rate();
    gathered_ = MarkerSequence(body_->labels, FramesOf(calibration_time_, rate), rate, 0);
  }
  num_gathered_ = 0;
  return true;
}

void LiveSession::Use(TrackingSetup setup, bool is_calibrated,
                      std::unique_ptr<MotionConverter> converter) {
  auto body = std::make_shared<LiveBody>();
  body->name = plan_->motion_name;
  body->setup = std::move(setup);
  body->labels = gathered_.labels();
  body->rate = layout_->rate;
  body->is_calibrated = is_calibrated;
  body->index = index_;
  body->count = count_;
  body_ = std::move(body);
  if (tracker_) starts_ += tracker_->starts();
  tracker_ = std::make_unique<LiveTracker>(std::move(converter), layout_->rate);
}

void LiveSession::Gather() {
  if (num_gathered_ < gathered_.num_frames()) gathered_.frame(num_gathered_++) = frame_.points;
}

void LiveSession::Calibrate() {
  stage_ = LiveStage::kCalibrating;
  Say(fmt::format("calibrating on {:.0f} s of movement", num_gathered_ / gathered_.rate()));
  calibrated_ = std::async(std::launch::async, [plan = *plan_, frames = gathered_] {
    UseAnyProcessor();
    Calibrated calibrated{CalibrateLive(plan, frames), nullptr};
    calibrated.converter = MakeConverter(plan, calibrated.person.setup);
    return calibrated;
  });
}

void LiveSession::TakeCalibration() {
  try {
    Calibrated calibrated = calibrated_.get();
    calibration_ = std::move(calibrated.person.result);
    plan_->person = std::move(calibrated.person.person);
    plan_->setup = calibrated.person.setup;
    if (labeller_) {
      labels_->setup.model = plan_->setup.model;
      labeller_->Use(labels_->setup);
    }
    for (const std::string& text : calibrated.person.warnings.texts()) Say(text);
    Say(fmt::format("calibrated: mean marker distance {:.1f} mm, before {:.1f} mm",
                    kMillimetres * calibration_->distance_after,
                    kMillimetres * calibration_->distance_before));
    Use(std::move(calibrated.person.setup), true, std::move(calibrated.converter));
  } catch (const Error& error) {
    calibration_time_ *= 2;
    const bool goes_on = calibration_time_ <= kLongestCalibration;
    Say(fmt::format("calibration: {}{}", error.what(),
                    goes_on ? "; once more, with more movement" : "; it is given up"));
    if (goes_on) {
      gathered_ = MarkerSequence(body_->labels, FramesOf(calibration_time_, gathered_.rate()),
                                 gathered_.rate(), 0);
      num_gathered_ = 0;
    } else {
      calibration_time_ = 0;
    }
  }
}

void LiveSession::TakePoints(const LaidOutFrame& frame, bool is_new) {
  const double time = clock_.Take(frame.frame.time, frame.frame.received, layout_->rate, is_new);
  if (clock_.outage() > 0) {
    Say(fmt::format("frame {}: the source's clock began anew; nothing came for {:.1f} s",
                    frame.frame.number, clock_.outage()));
  }
  frame_.time = time;
  if (labeller_) labeller_->Name(frame.frame, &frame_.points);
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    frame_.points.col(static_cast<Eigen::Index>(i)) = frame.frame.points.col(columns_[i]);
  }
  pose_.number = frame.frame.number;
  pose_.time = time;
  pose_.received = frame.frame.received;
  pose_.points = frame_.points;
  pose_.counts = frame.counts;
}

void LiveSession::Track() {
  const FrameEstimate* estimate = tracker_->Track(frame_.points, frame_.time);
  pose_.is_tracking = estimate != nullptr;
  if (estimate != nullptr) pose_.estimate = *estimate;
  const bool is_tracked = tracker_->is_tracking();
  const bool was_waiting = stage_ <= LiveStage::kWaiting;
  if (is_tracked && was_waiting) Say(fmt::format("frame {}: {} is seen", pose_.number, Who()));
  if (!is_tracked && !was_waiting) {
    Say(fmt::format("frame {}: {} is not seen any more", pose_.number, Who()));
  }
  stage_ = is_tracked ? LiveStage::kTracking : LiveStage::kWaiting;
}

void LiveSession::GoOnCalibrating() {
  if (calibrated_.valid()) {
    stage_ = LiveStage::kCalibrating;
    return;
  }
  stage_ = LiveStage::kGathering;
  Gather();
  if (num_gathered_ == gathered_.num_frames()) Calibrate();
}

std::string LiveSession::Who() const { return plan_->object ? plan_->motion_name : "the person"; }

void LiveSession::Prepare() {
  if (tracker_) tracker_->Prepare();
}

const PoseFrame& LiveSession::Take(const LaidOutFrame& frame, std::int64_t dropped) {
  const bool is_new = frame.layout != layout_;
  if (is_new) {
    layout_ = frame.layout;
    Begin(*layout_);
  }
  TakePoints(frame, is_new);
  pose_.dropped = dropped;
  pose_.is_tracking = false;
  if (!tracker_) {
    if (ShowsPerson(frame_)) Gather();
    if (num_gathered_ == gathered_.num_frames()) TryToPlan(true);
  }
  if (calibrated_.valid() &&
      calibrated_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    TakeCalibration();
  }
  if (tracker_) {
    Track();
    const bool is_wanted = calibration_time_ > 0 && !body_->is_calibrated;
    if (is_wanted && tracker_->is_tracking()) GoOnCalibrating();
  }
  pose_.stage = stage_text();
  pose_.progress = stage_ == LiveStage::kGathering ? gathered() : 1;
  pose_.tracked = std::chrono::steady_clock::now();
  return pose_;
}

}  // namespace mmm_converter
