// SPDX-License-Identifier: MIT
#include "common/judge/conversion_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "common/fit/rigid_shape.h"
#include "common/judge/body_limits.h"
#include "common/judge/coverage.h"
#include "common/judge/evidence.h"
#include "common/judge/limb_places.h"
#include "common/math/statistics.h"
#include "common/model/coordinate_map.h"
#include "common/motion/marker_residuals.h"
#include "common/support/advice.h"
#include "common/support/error.h"
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
      : evidence_(evidence),
        markers_(evidence.recording.markers),
        figures_(evidence.figures),
        limbs_(LimbsOf(evidence.setup)) {}

  Verdict Run() {
    JudgeReading(evidence_.recording, &reasons_);
    JudgeLength();
    if (evidence_.is_object) {
      JudgeObjectsDistance();
      JudgeGaps();
      return reasons_.Conclude();
    }
    const bool is_far = JudgeDistances();
    JudgeMarkers();
    JudgeFarthest();
    JudgeCoverage(evidence_.setup, limbs_, &reasons_);
    JudgeLimbPlaces(evidence_.setup, limbs_, markers_, evidence_.result, &reasons_);
    if (evidence_.names != nullptr) JudgeNames(*evidence_.names, &reasons_);
    JudgeGaps();
    JudgeJumps();
    JudgeTrack();
    JudgeNoise(evidence_.setup, markers_, &reasons_);
    JudgeUpright();
    JudgeBodyLimits(evidence_.setup, markers_, evidence_.result.trajectory,
                    evidence_.person.subject != nullptr, &reasons_);
    JudgeHeight(is_far);
    if (is_far || AreAtLandmarks()) {
      JudgeSides(evidence_.setup, evidence_.reference, evidence_.person, markers_, &reasons_);
    }
    return reasons_.Conclude();
  }

 private:
  // By names, or by a set that knows most places better than one of reference markers does.
  bool AreAtLandmarks() const {
    const std::vector<MarkerAssignment>& all = evidence_.setup.assignments();
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
      labels.push_back(markers_.labels()[evidence_.setup.assignments()[i].label]);
    }
    return FirstNames(labels, 6);
  }

  void JudgeObjectsDistance() {
    Eigen::Matrix3Xd places(3, static_cast<Eigen::Index>(evidence_.setup.assignments().size()));
    for (Eigen::Index i = 0; i < places.cols(); ++i) {
      const int marker = evidence_.setup.assignments()[static_cast<std::size_t>(i)].marker;
      places.col(i) = evidence_.setup.model->markers()[marker].p_SM;
    }
    const double radius = RadiusOf(places);
    reasons_.AddBeyond(
        kObject, figures_.distance.mean / radius,
        fmt::format(
            "the markers are {:.1f} mm from the model {}, whose radius is {:.0f} mm (both on "
            "average); is it this object's?",
            kMillimetres * figures_.distance.mean, evidence_.model_file, kMillimetres * radius));
  }

  // Whether the markers are farther from the model than a person's are.
  bool JudgeDistances() {
    const bool is_calibrated = evidence_.person.subject != nullptr;
    const Limit& mean = is_calibrated ? kCalibratedMeanDistance : kMeanDistance;
    const Limit& percentile = is_calibrated ? kCalibratedPercentile : kPercentile;
    const char* person = is_calibrated ? "a calibrated person" : "a person of that height";
    bool is_far = reasons_.AddBeyond(
        mean, figures_.distance.mean,
        fmt::format("markers are {:.0f} mm from the model on average, those of "
                    "{} at most {:.0f}",
                    kMillimetres * figures_.distance.mean, person, kMillimetres * mean.check));
    is_far |= reasons_.AddBeyond(
        percentile, figures_.distance.p95,
        fmt::format("5 % of the marker positions are more than {:.0f} mm from the "
                    "model, of {} at most {:.0f}",
                    kMillimetres * figures_.distance.p95, person, kMillimetres * percentile.check));
    if (!is_calibrated) return is_far;
    is_far |= JudgeOffsets(*evidence_.person.subject, &reasons_);
    JudgeProportions(*evidence_.person.subject, &reasons_);
    return is_far;
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
    const bool is_told_by_size = evidence_.person.size && !evidence_.person.subject;
    if (is_told_by_size && most == 0) {
      JudgePlaces(evidence_.setup, markers_, evidence_.result.trajectory, &reasons_);
    }
  }

  void JudgeFarthest() {
    if (!kFarthest.IsBeyond(figures_.distance.max)) return;
    const auto is_far = evidence_.result.residuals.array() > kFarthest.check;
    Eigen::Index worst = 0, frame = 0;
    is_far.select(evidence_.result.residuals, 0).maxCoeff(&worst, &frame);
    const auto frames = is_far.colwise().any().count();
    reasons_.AddBeyond(
        kFarthest, figures_.distance.max,
        fmt::format("in {} {} a marker is more than {:.0f} mm from the model; farthest is {} in "
                    "frame {}, by {:.0f} mm",
                    frames, frames == 1 ? "frame" : "frames", kMillimetres * kFarthest.check,
                    LabelsOf({static_cast<int>(worst)}), evidence_.first_frame + frame,
                    kMillimetres * figures_.distance.max));
  }

  void JudgeGaps() {
    const int late = FramesBeforeFirstSeen(evidence_.result.residuals);
    for (const Gap& gap : LongGaps(evidence_.setup, markers_)) {
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

  // How far the markers are from where they were a frame before: of half of them, further.
  double StepTo(int k) const {
    std::vector<double> steps;
    for (const MarkerAssignment& one : evidence_.setup.assignments()) {
      const double step =
          (markers_.frame(k).col(one.label) - markers_.frame(k - 1).col(one.label)).norm();
      if (!std::isnan(step)) steps.push_back(step);
    }
    return static_cast<int>(steps.size()) < kFewestMarkers ? kNaN : Median(steps);
  }

  // Where a body is elsewhere within a frame, and is as slow before as after, it is another one: on
  // half of the way it speeds up, on the other half it stops.
  void JudgeJumps() {
    const double most =
        std::max(kLeastJump, kMostAcceleration / (4 * markers_.rate() * markers_.rate()));
    double before = kNaN, step = kNaN, farthest = 0;
    int jumps = 0, first = 0;
    for (int k = 1; k < markers_.num_frames(); ++k) {
      const double after = StepTo(k);
      const bool is_known = !std::isnan(before) && !std::isnan(after);
      const double jump = is_known ? step - std::max(before, after) : kNaN;
      before = step;
      step = after;
      if (!(jump > most)) continue;
      if (jumps++ == 0) first = k - 1;
      farthest = std::max(farthest, jump);
    }
    if (jumps == 0) return;
    reasons_.Add(Level::kCheck,
                 fmt::format("the markers jump {} {} by up to {:.0f} mm within a frame, first in "
                             "frame {}: are they another person's there, or do frames lack?",
                             jumps, jumps == 1 ? "time" : "times", kMillimetres * farthest,
                             evidence_.first_frame + first));
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
    constexpr double kUpright = 0.5;  // cosine of 60 degrees
    const Recording& recording = evidence_.recording;
    if (recording.up_axis_is_doubtful) return;  // that has been said
    const KinematicModel& model = *evidence_.setup.model;
    if (model.is_root_fixed()) return;
    // Of the root that is upright.
    Eigen::Vector3d up_S = Eigen::Vector3d::UnitZ();
    if (model.coordinates()) up_S = RestPosture(model).orientation.inverse() * up_S;
    double lying = 0;
    double upside_down = 0;
    for (const Posture& posture : evidence_.result.trajectory.postures) {
      const double up = (posture.orientation.toRotationMatrix() * up_S).z();
      lying += up < kUpright ? 1 : 0;
      upside_down += up < -kUpright ? 1 : 0;
    }
    const auto frames = static_cast<double>(evidence_.result.trajectory.postures.size());
    const std::string throughout =
        WithAdvice(fmt::format("in more than {:.0f} % of the frames, with {} of the file as up",
                               kPercent * kLyingFrames.check, Name(recording.up_axis)),
                   Remedy::kUpAxis);
    if (reasons_.AddBeyond(kLyingFrames, upside_down / frames,
                           "the body is upside down " + throughout)) {
      return;
    }
    reasons_.AddBeyond(kLyingFrames, lying / frames, "the trunk lies " + throughout);
  }

  // A height that was given beside the one that the markers tell.
  void JudgeHeight(bool is_far) {
    if (evidence_.height_source.empty()) return;
    const double height = evidence_.person.size->height;
    std::optional<HeightEstimate> estimate;
    try {
      const auto* track = is_far ? nullptr : &evidence_.result.trajectory.postures;
      estimate = EstimateHeight(evidence_.setup, *evidence_.reference, markers_, track);
    } catch (const Error&) {
      return;  // too few markers
    }
    if (kMeanDistance.IsBeyond(estimate->mean_distance)) return;  // no height explains the markers
    reasons_.AddBeyond(
        kHeight, std::abs(estimate->height / height - 1),
        fmt::format("the height is {:.2f} m ({}), but the markers are those of a person of "
                    "{:.2f} m",
                    height, evidence_.height_source, estimate->height));
  }

  const ConversionEvidence& evidence_;
  const MarkerSequence& markers_;
  const ConversionFigures& figures_;
  const std::vector<Limb> limbs_;
  VerdictReasons reasons_;
};

}  // namespace

Verdict JudgeConversion(const ConversionEvidence& evidence) { return Judge(evidence).Run(); }

}  // namespace mmm_converter
