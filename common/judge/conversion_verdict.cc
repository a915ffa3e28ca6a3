// SPDX-License-Identifier: MIT
#include "common/judge/conversion_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/fit/rigid_shape.h"
#include "common/judge/body_rules.h"
#include "common/motion/marker_residuals.h"
#include "common/support/advice.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Level = Verdict::Level;

// One position. A marker on skin or a wand is at most 0.18 from the model (above), and 0.25 for 0.1
// s of a somersault; the frame, or the label in it, is wrong beyond.
constexpr Limit kFarthest = {0.3, kNever};
// Of a posture that is not tracked [s]: what a prediction bridges.
constexpr Limit kLateStart = {0.5, kNever};
// Share of the frames: right at most 0.06; left and right exchanged 0.1 to 0.8.
constexpr Limit kReassembled = {0.1, 0.5};
// Share of the seen positions: right at most 0.001; legs exchanged 0.02.
constexpr Limit kWrongLabels = {0.01, 0.2};
// Share of the frames: who lies now and then also stands.
constexpr Limit kLyingFrames = {0.9, kNever};
// What the median label of no recording at hand is accelerated by, fast punches and falls among
// them [m/s^2], and what a jump is at least [m].
constexpr double kMostAcceleration = 100;
constexpr double kLeastJump = 0.1;
// Of a motion: nothing moves in fewer, so that no label or marker that is wrong shows.
constexpr int kFewestFrames = 10;
// Mean distance over an object's radius.
constexpr Limit kObject = {kMostStray, 0.5};

class Judge {
 public:
  explicit Judge(const ConversionEvidence& evidence)
      : evidence_(evidence), markers_(evidence.recording.markers), figures_(evidence.figures) {}

  Questions Ask() const {
    Questions asked;
    if (is_object()) return asked;
    const bool is_any_far =
        std::any_of(figures_.of_markers.begin(), figures_.of_markers.end(),
                    [](const auto& one) { return kMarkerMean.IsBeyond(one.mean); });
    asked.is_far = IsFar();
    asked.places = evidence_.height > 0 && !is_calibrated() && !is_any_far;
    asked.sides = asked.is_far || AreAtLandmarks();
    asked.height = !evidence_.height_source.empty();
    return asked;
  }

  Verdict Run() {
    JudgeReading(evidence_.recording, &reasons_);
    JudgeLength();
    if (is_object()) {
      JudgeObjectsDistance();
      JudgeGaps();
      return reasons_.Conclude();
    }
    const BodyFigures& body = evidence_.body;
    JudgeDistances();
    JudgeMarkers();
    JudgePlaces(evidence_.labels.places, &reasons_);
    JudgeFarthest();
    JudgeCoverage(body.coverage, &reasons_);
    JudgeLimbPlaces(body.limb_places, &reasons_);
    if (evidence_.names != nullptr) JudgeNames(*evidence_.names, &reasons_);
    JudgeGaps();
    JudgeJumps();
    JudgeTrack();
    JudgeNoise(body.noise, &reasons_);
    JudgeUpright();
    JudgeBodyLimits(body.limits, is_calibrated(), &reasons_);
    JudgeSlips(body.slipped, &reasons_);
    JudgeHeight();
    JudgeSides(evidence_.labels.sides, &reasons_);
    return reasons_.Conclude();
  }

 private:
  bool is_object() const { return !evidence_.object_model.empty(); }
  bool is_calibrated() const { return evidence_.subject != nullptr; }

  // By names, or by a set that knows most places better than one of reference markers does.
  bool AreAtLandmarks() const {
    const std::vector<MarkerAssignment>& all = evidence_.assignments;
    const auto known = std::count_if(
        all.begin(), all.end(), [](const MarkerAssignment& one) { return one.noise_scale < 1; });
    return evidence_.names != nullptr || 2 * known > static_cast<long>(all.size());
  }

  void JudgeLength() {
    if (markers_.num_frames() >= kFewestFrames) return;
    reasons_.Add(Level::kCheck,
                 fmt::format("{} frame{} too few to judge a motion by", markers_.num_frames(),
                             markers_.num_frames() == 1 ? " is" : "s are"));
  }

  std::string LabelsOf(const std::vector<int>& assignments) const {
    std::vector<std::string> labels;
    labels.reserve(assignments.size());
    for (const int i : assignments) {
      labels.push_back(markers_.labels()[evidence_.assignments[i].label]);
    }
    return FirstNames(labels, 6);
  }

  void JudgeObjectsDistance() {
    const double radius = evidence_.body.radius;
    reasons_.AddBeyond(
        kObject, figures_.distance.mean / radius,
        fmt::format(
            "the markers are {:.1f} mm from the model {}, whose radius is {:.0f} mm (both on "
            "average); is it this object's?",
            kMillimetres * figures_.distance.mean, evidence_.object_model, kMillimetres * radius));
  }

  const Limit& MeanLimit() const {
    return is_calibrated() ? kCalibratedMeanDistance : kMeanDistance;
  }
  const Limit& PercentileLimit() const {
    return is_calibrated() ? kCalibratedPercentile : kPercentile;
  }

  // Whether the markers are farther from the model than a person's are.
  bool IsFar() const {
    return MeanLimit().IsBeyond(figures_.distance.mean) ||
           PercentileLimit().IsBeyond(figures_.distance.p95) ||
           (is_calibrated() && AreOffsetsFar(*evidence_.subject));
  }

  void JudgeDistances() {
    const Limit& mean = MeanLimit();
    const Limit& percentile = PercentileLimit();
    const char* person = is_calibrated() ? "a calibrated person" : "a person of that height";
    reasons_.AddBeyond(
        mean, figures_.distance.mean,
        fmt::format("markers are {:.0f} mm from the model on average, those of "
                    "{} at most {:.0f}",
                    kMillimetres * figures_.distance.mean, person, kMillimetres * mean.check));
    reasons_.AddBeyond(
        percentile, figures_.distance.p95,
        fmt::format("5 % of the marker positions are more than {:.0f} mm from the "
                    "model, of {} at most {:.0f}",
                    kMillimetres * figures_.distance.p95, person, kMillimetres * percentile.check));
    if (!is_calibrated()) return;
    JudgeOffsets(*evidence_.subject, &reasons_);
    JudgeLandmarks(*evidence_.subject, &reasons_);
    JudgeProportions(*evidence_.subject, &reasons_);
  }

  void JudgeMarkers() {
    std::vector<int> far;
    double most = 0;
    for (std::size_t i = 0; i < figures_.of_markers.size(); ++i) {
      const double mean = figures_.of_markers[i].mean;
      if (!kMarkerMean.IsBeyond(mean)) continue;
      far.push_back(static_cast<int>(i));
      most = std::max(most, mean);
    }
    reasons_.AddBeyond(
        kMarkerMean, most,
        fmt::format("{} of {} markers are on average more than {:.0f} mm from where the body "
                    "can have them: {}; are they this person's?",
                    far.size(), figures_.of_markers.size(), kMillimetres * kMarkerMean.check,
                    LabelsOf(far)));
  }

  // But for markers that bear each other's labels: the track takes them for each other.
  void JudgeFarthest() {
    if (!kFarthest.IsBeyond(figures_.distance.max)) return;
    Eigen::MatrixXd residuals = evidence_.result.residuals;
    for (const MarkerIncident& one : evidence_.result.incidents) {
      if (one.kind != MarkerIncident::Kind::kSwapped) continue;
      const int length = one.last_frame - one.first_frame + 1;
      residuals.row(one.assignment).segment(one.first_frame, length).setZero();
      residuals.row(one.other).segment(one.first_frame, length).setZero();
    }
    const auto is_far = residuals.array() > kFarthest.check;
    Eigen::Index worst = 0, frame = 0;
    const double most = is_far.select(residuals, 0).maxCoeff(&worst, &frame);
    const auto frames = is_far.colwise().any().count();
    reasons_.AddBeyond(
        kFarthest, most,
        fmt::format("in {} {} a marker is more than {:.0f} mm from the model; farthest is {} in "
                    "frame {}, by {:.0f} mm",
                    frames, frames == 1 ? "frame" : "frames", kMillimetres * kFarthest.check,
                    LabelsOf({static_cast<int>(worst)}), evidence_.first_frame + frame,
                    kMillimetres * most));
  }

  void JudgeGaps() {
    const int late = FramesBeforeFirstSeen(evidence_.result.residuals);
    for (const Gap& gap : evidence_.body.gaps) {
      if (gap.last_frame < late) continue;
      reasons_.Add(Level::kCheck,
                   fmt::format("{} is hidden for {:.1f} s, frames {} to {}", gap.what, gap.seconds,
                               evidence_.first_frame + gap.first_frame,
                               evidence_.first_frame + gap.last_frame));
    }
    reasons_.AddBeyond(
        kLateStart, late / markers_.rate(),
        WithAdvice(fmt::format("the body is hidden, or shows too few markers to begin, for {:.1f} "
                               "s, frames {} to {}, which have the posture of the frame after them",
                               late / markers_.rate(), evidence_.first_frame,
                               evidence_.first_frame + late - 1),
                   Remedy::kFrames));
  }

  // A body that is elsewhere within a frame, and is as slow before as after, is another one: on
  // half of the way it speeds up, on the other half it stops.
  void JudgeJumps() {
    const double most =
        std::max(kLeastJump, kMostAcceleration / (4 * markers_.rate() * markers_.rate()));
    double farthest = 0;
    int jumps = 0;
    std::size_t first = 0;
    for (std::size_t k = 0; k < evidence_.body.jumps.size(); ++k) {
      const double jump = evidence_.body.jumps[k];
      if (!(jump > most)) continue;
      if (jumps++ == 0) first = k;
      farthest = std::max(farthest, jump);
    }
    if (jumps == 0) return;
    reasons_.Add(Level::kCheck,
                 fmt::format("the markers jump {} {} by up to {:.0f} mm within a frame, first in "
                             "frame {}: are they another person's there, or do frames lack?",
                             jumps, jumps == 1 ? "time" : "times", kMillimetres * farthest,
                             evidence_.first_frame + static_cast<int>(first)));
  }

  void JudgeTrack() {
    const double frames = markers_.num_frames();
    reasons_.AddBeyond(kReassembled, figures_.frames_reassembled / frames,
                       fmt::format("the track was lost and reinitialised in {} of {} frames",
                                   figures_.frames_reassembled, markers_.num_frames()));
    double wrong = 0;
    std::vector<int> assignments;
    for (const MarkerIncident& incident : evidence_.result.incidents) {
      const int length = incident.last_frame - incident.first_frame + 1;
      wrong += length * (incident.other >= 0 ? 2 : 1);
      if (std::count(assignments.begin(), assignments.end(), incident.assignment) == 0) {
        assignments.push_back(incident.assignment);
      }
    }
    const double share = wrong / std::max(1.0, static_cast<double>(figures_.distance.seen));
    reasons_.AddBeyond(
        kWrongLabels, share,
        fmt::format("{:.0f} % of the marker positions are not where their labels belong: {}; "
                    "label {} finds such labels",
                    kPercent * share, LabelsOf(assignments), OptionText("repair")));
  }

  // Whether the trunk was ever upright.
  void JudgeUpright() {
    const Recording& recording = evidence_.recording;
    if (recording.up_axis_is_doubtful) return;  // that has been said
    const TrunkFigures& trunk = evidence_.body.trunk;
    const std::string throughout =
        WithAdvice(fmt::format("in more than {:.0f} % of the frames, with {} of the file as up",
                               kPercent * kLyingFrames.check, Name(recording.up_axis)),
                   Remedy::kUpAxis);
    if (reasons_.AddBeyond(kLyingFrames, trunk.upside_down,
                           "the body is upside down " + throughout)) {
      return;
    }
    reasons_.AddBeyond(kLyingFrames, trunk.lying, "the trunk lies " + throughout);
  }

  // A height that was given beside the one that the markers tell.
  void JudgeHeight() {
    const std::optional<HeightEstimate>& estimate = evidence_.told_height;
    if (!estimate) return;
    if (kMeanDistance.IsBeyond(estimate->mean_distance)) return;  // no height explains the markers
    reasons_.AddBeyond(
        kHeight, std::abs(estimate->height / evidence_.height - 1),
        fmt::format("the height is {:.2f} m ({}), but the markers are those of a person of "
                    "{:.2f} m",
                    evidence_.height, evidence_.height_source, estimate->height));
  }

  const ConversionEvidence& evidence_;
  const MarkerSequence& markers_;
  const ConversionFigures& figures_;
  VerdictReasons reasons_;
};

}  // namespace

Questions AskAboutConversion(const ConversionEvidence& evidence) { return Judge(evidence).Ask(); }

Verdict JudgeConversion(const ConversionEvidence& evidence) { return Judge(evidence).Run(); }

}  // namespace mmm_converter
