// SPDX-License-Identifier: MIT
#include "common/label/track/labelled_person.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "common/calibrate/calibration.h"
#include "common/label/track/exchanged_names.h"
#include "common/label/tuning.h"
#include "common/support/error.h"

namespace mmm_converter {

using Eigen::Vector3d;

namespace {

bool IsCalibrated(const TrackingSetup& setup) {
  return std::any_of(setup.assignments().begin(), setup.assignments().end(),
                     [&setup](const MarkerAssignment& assignment) {
                       return setup.model->markers()[assignment.marker].deviation.has_value();
                     });
}

}  // namespace

LabelledPerson::LabelledPerson(const TrackingSetup& setup, int first_marker,
                               const PointTracks& tracks, double dt)
    : setup_(setup),
      was_calibrated_(IsCalibrated(setup)),
      is_calibrated_(was_calibrated_),
      first_marker_(first_marker),
      tracks_(tracks),
      dt_(dt),
      body_(std::make_unique<LabelBody>(setup)) {
  const auto frames = static_cast<double>(tracks.frames.size());
  kept_every_ = static_cast<int>(std::ceil(
      std::max({1.0, RecordingTuning::kKeptEvery / dt, frames / RecordingTuning::kMostKept})));
}

void LabelledPerson::Start(const BodyMatch& match) {
  tracker_ = std::make_unique<LabelTracker>(*body_);
  tracker_->Start(match);
}

const std::vector<int>& LabelledPerson::Follow() {
  const std::vector<int>& found = tracker_->Track(points, dt_, hints);
  const auto matched = std::count_if(found.begin(), found.end(), [](int p) { return p >= 0; });
  watch_.Count(static_cast<int>(matched), static_cast<int>(points.cols()), body_->num_markers(),
               dt_);
  if (!watch_.IsLost()) return found;
  watch_.Restart();
  if (!MaySearch()) return found;
  ++searches_.made;
  BodySearch search(*body_);
  const BodyMatch anew = search.SettleFinely(points, search.Find(points).posture);
  const bool fits =
      watch_.Fits(anew.matched, static_cast<int>(points.cols()), body_->num_markers());
  const double now = search.SettleFinely(points, tracker_->belief().posture).cost;
  const bool is_replaced = watch_.IsReplaced(now, anew.cost);
  if (is_replaced) tracker_->Start(anew);
  if (!fits || !is_replaced) ++searches_.vain;
  return found;
}

bool LabelledPerson::MaySearch() const {
  constexpr int kMostVain = RecordingTuning::kMostVainSearches;
  const double recorded = dt_ * static_cast<double>(tracks_.frames.size());  // [s]
  return searches_.vain < kMostVain && searches_.made < kMostVain + recorded;
}

void LabelledPerson::KeepFrame(int frame, const std::vector<int>& point_of_marker) {
  CountUnmatched(frame, point_of_marker);
  if (was_calibrated_ && frame % kept_every_ == kept_every_ / 2) {
    kept_.emplace_back(frame, tracker_->belief().posture);
  }
}

void LabelledPerson::Improve(TrackNames* names) {
  if (was_calibrated_) {
    ExchangedNames exchanged(*body_, tracks_, first_marker_);
    for (const auto& [frame, posture] : kept_) exchanged.AddFrame(frame, posture);
    exchanged.Improve(names);
    kept_.clear();
  }
  NameWornElsewhere(names);
  elsewhere_ = WornElsewhere();
}

void LabelledPerson::CountUnmatched(int frame, const std::vector<int>& point_of_marker) {
  std::vector<char> is_used(offered.size(), 0);
  for (const int point : point_of_marker) {
    if (point >= 0) is_used[point] = 1;
  }
  for (int m = 0; m < body_->num_markers(); ++m) {
    if (point_of_marker[m] >= 0 || tracker_->deviations()[m] > RecordingTuning::kKnown) continue;
    for (std::size_t p = 0; p < is_used.size(); ++p) {
      const int track = tracks_.frames[frame].tracks[offered[p]];
      const PointTrack& followed = tracks_.tracks[track];
      if (is_used[p] != 0 || followed.end - followed.begin < ElsewhereTuning::kLeastFrames)
        continue;
      const Vector3d p_WP = points.col(static_cast<Eigen::Index>(p));
      elsewhere_.Add(m, track, tracker_->OffsetOf(m, p_WP), p_WP);
    }
  }
}

void LabelledPerson::NameWornElsewhere(TrackNames* names) const {
  const auto frames = tracks_.frames.size();
  std::vector<std::vector<char>> has_point(  // by marker
      static_cast<std::size_t>(body_->num_markers()), std::vector<char>(frames, 0));
  const auto part = [](std::vector<char>* of, const PointTrack& track) {
    return std::span<char>(*of).subspan(track.begin, track.end - track.begin);
  };
  for (std::size_t t = 0; t < tracks_.tracks.size(); ++t) {
    if (!IsMarker(names->markers[t])) continue;
    std::ranges::fill(part(&has_point[names->markers[t] - first_marker_], tracks_.tracks[t]), 1);
  }
  std::vector<char> is_mostly_found;
  is_mostly_found.reserve(has_point.size());
  for (const auto& has : has_point) {
    const auto found = static_cast<std::size_t>(std::count(has.begin(), has.end(), 1));
    is_mostly_found.push_back(2 * found > frames ? 1 : 0);
  }
  const double reach =
      was_calibrated_ ? ElsewhereTuning::kReachCalibrated : ElsewhereTuning::kReach;
  for (const auto& [marker, track] : elsewhere_.Find(dt_, reach)) {
    const std::span<char> has = part(&has_point[marker], tracks_.tracks[track]);
    const bool is_taken = std::ranges::find(has, 1) != has.end();
    if (names->markers[track] >= 0 || is_mostly_found[marker] != 0 || is_taken) continue;
    std::ranges::fill(has, 1);
    names->markers[track] = first_marker_ + marker;
    names->shares[track] = ElsewhereTuning::kShare;
  }
}

MarkerSequence LabelledPerson::Named(const TrackNames& names) const {
  std::vector<std::string> labels;
  labels.reserve(body_->num_markers());
  for (int m = 0; m < body_->num_markers(); ++m) labels.push_back(std::to_string(m));
  MarkerSequence named(labels, static_cast<int>(tracks_.frames.size()), 1 / dt_, 0);
  for (std::size_t t = 0; t < tracks_.tracks.size(); ++t) {
    const PointTrack& track = tracks_.tracks[t];
    if (!IsMarker(names.markers[t]) || names.shares[t] < RecordingTuning::kSureName) continue;
    const int marker = names.markers[t] - first_marker_;
    for (int k = track.begin; k < track.end; ++k) {
      named.frame(k).col(marker) = tracks_.frames[k].p_WP.col(track.points[k - track.begin]);
    }
  }
  return named;
}

bool LabelledPerson::Calibrate(const TrackNames& names,
                               const std::function<void()>& between_steps) {
  if (is_calibrated_) return false;
  const MarkerSequence named = Named(names);
  std::vector<MarkerAssignment> assignments = setup_.assignments();
  for (std::size_t m = 0; m < assignments.size(); ++m) {
    assignments[m].label = LabelIx(static_cast<int>(m));
  }
  CalibrationOptions options;
  options.between_steps = between_steps;
  try {
    const CalibrationResult result =
        CalibrateSubject(*setup_.model, setup_.joints, {{"", &named, assignments}}, options);
    setup_.model =
        std::make_shared<const KinematicModel>(FitToSubject(*setup_.model, result.subject));
  } catch (const Error&) {
    return false;  // too short or too still: as before
  }
  is_calibrated_ = true;
  BodyMatch where;
  where.posture = tracker_->belief().posture;
  tracker_.reset();
  body_ = std::make_unique<LabelBody>(setup_);
  Start(where);
  return true;
}

}  // namespace mmm_converter
