// SPDX-License-Identifier: MIT
#include "common/pipeline/verdict.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "common/fit/rigid_shape.h"
#include "common/judge/coverage.h"
#include "common/pipeline/conversion.h"
#include "common/pipeline/conversion_figures.h"
#include "common/pipeline/judgement.h"
#include "common/pipeline/person_calibration.h"
#include "common/support/advice.h"
#include "common/support/error.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Level = Verdict::Level;

// The 95th percentile of the distances: right 0.05 to 0.11; legs exchanged 0.19, others' markers
// 0.5 to 1.8.
constexpr Limit kPercentile = {0.15, 0.4};
// The same of a calibrated person: right 0.006 to 0.024.
constexpr Limit kCalibratedPercentile = {0.06, 0.2};
// The average of one marker: right at most 0.18; another person's 1.1 to 1.7.
constexpr Limit kMarkerMean = {0.22, 0.6};
// A height beside the estimated one, relative, which is within 0.035 of the true one.
constexpr Limit kHeight = {0.08, 0.2};
// Share of the frames: right at most 0.06; left and right exchanged 0.1 to 0.8.
constexpr Limit kReassembled = {0.1, 0.5};
// Share of the seen positions: right at most 0.001; legs exchanged 0.02.
constexpr Limit kWrongLabels = {0.01, 0.2};
// Share of the frames: who lies now and then also stands.
constexpr Limit kLyingFrames = {0.9, kNever};
// Mean distance over an object's radius.
constexpr Limit kObject = {kMostStray, 0.5};

class Judge {
 public:
  explicit Judge(const ConversionReport& report)
      : report_(report),
        markers_(report.input.recording.markers),
        figures_(report.figures),
        limbs_(LimbsOf(report.setup)) {}

  Verdict Run() {
    JudgeReading(report_.input.recording, &judgement_);
    if (report_.object) {
      JudgeObjectsDistance();
      JudgeGaps();
      return judgement_.Take();
    }
    const bool is_far = JudgeDistances();
    JudgeMarkers();
    JudgeCoverage(report_.setup, limbs_, &judgement_);
    JudgeGaps();
    JudgeTrack();
    JudgeNoise(report_.setup, markers_, &judgement_);
    JudgeUpright();
    JudgeHeight(is_far);
    if (is_far) {
      JudgeSides(report_.setup, report_.input.reference,
                 ScalingOf(report_.person, report_.converter.config), markers_, &judgement_);
    }
    return judgement_.Take();
  }

 private:
  std::string LabelsOf(const std::vector<int>& assignments) const {
    std::vector<std::string> labels;
    for (const int i : assignments) labels.push_back(LabelOf(report_, i));
    return FirstNames(labels, 6);
  }

  void JudgeObjectsDistance() {
    Eigen::Matrix3Xd places(3, static_cast<Eigen::Index>(report_.setup.assignments().size()));
    for (Eigen::Index i = 0; i < places.cols(); ++i) {
      const int marker = report_.setup.assignments()[static_cast<std::size_t>(i)].marker;
      places.col(i) = report_.setup.model->markers()[marker].p_SM;
    }
    const double radius = RadiusOf(places);
    judgement_.AddBeyond(
        kObject, figures_.distance.mean / radius,
        fmt::format(
            "the markers are {:.1f} mm from the model {}, whose radius is {:.0f} mm (both on "
            "average); is it this object's?",
            kMillimetres * figures_.distance.mean, report_.input.model_file,
            kMillimetres * radius));
  }

  // Whether the markers are farther from the model than a person's are.
  bool JudgeDistances() {
    const bool is_calibrated = report_.person.subject != nullptr;
    const Limit& mean = is_calibrated ? kCalibratedMeanDistance : kMeanDistance;
    const Limit& percentile = is_calibrated ? kCalibratedPercentile : kPercentile;
    const char* person = is_calibrated ? "a calibrated person" : "a person of that height";
    bool is_far = judgement_.AddBeyond(
        mean, figures_.distance.mean,
        fmt::format("markers are {:.0f} mm from the model on average, those of "
                    "{} at most {:.0f}",
                    kMillimetres * figures_.distance.mean, person, kMillimetres * mean.check));
    is_far |= judgement_.AddBeyond(
        percentile, figures_.distance.p95,
        fmt::format("one in twenty marker positions is more than {:.0f} mm from the "
                    "model, of {} at most {:.0f}",
                    kMillimetres * figures_.distance.p95, person, kMillimetres * percentile.check));
    if (!is_calibrated) return is_far;
    is_far |= JudgeOffsets(*report_.person.subject, &judgement_);
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
    judgement_.AddBeyond(
        kMarkerMean, most,
        fmt::format("{} of {} markers are on average more than {:.0f} mm from where the body "
                    "can have them: {}; are they this person's?",
                    far.size(), figures_.of_markers.size(), kMillimetres * kMarkerMean.check,
                    LabelsOf(far)));
  }

  void JudgeGaps() {
    for (const Gap& gap : LongGaps(report_.setup, limbs_, markers_)) {
      judgement_.Add(Level::kCheck,
                     fmt::format("{} is hidden for {:.1f} s, frames {} to {}", gap.what,
                                 gap.seconds, report_.input.first_frame + gap.first_frame,
                                 report_.input.first_frame + gap.last_frame));
    }
  }

  void JudgeTrack() {
    const double frames = markers_.num_frames();
    judgement_.AddBeyond(kReassembled, figures_.frames_reassembled / frames,
                         fmt::format("the track was lost and reinitialised in {} of {} frames",
                                     figures_.frames_reassembled, markers_.num_frames()));
    double wrong = 0;
    std::vector<int> assignments;
    for (const MarkerIncident& incident : report_.result.incidents) {
      const int length = incident.last_frame - incident.first_frame + 1;
      wrong += length * (incident.other >= 0 ? 2 : 1);
      if (std::count(assignments.begin(), assignments.end(), incident.assignment) == 0) {
        assignments.push_back(incident.assignment);
      }
    }
    const double share = wrong / std::max(1.0, static_cast<double>(figures_.distance.seen));
    judgement_.AddBeyond(
        kWrongLabels, share,
        fmt::format("{:.0f} % of the marker positions are not where their labels belong: {}; "
                    "label {} finds such labels",
                    kPercent * share, LabelsOf(assignments), OptionText("repair")));
  }

  // Whether the trunk was ever upright.
  void JudgeUpright() {
    constexpr double kUpright = 0.5;  // cosine of 60 degrees
    const Recording& recording = report_.input.recording;
    if (recording.up_axis_is_doubtful) return;  // that has been said
    double lying = 0;
    double upside_down = 0;
    for (const Posture& posture : report_.result.trajectory.postures) {
      const double up = posture.orientation.toRotationMatrix()(2, 2);
      lying += up < kUpright ? 1 : 0;
      upside_down += up < -kUpright ? 1 : 0;
    }
    const auto frames = static_cast<double>(report_.result.trajectory.postures.size());
    const std::string throughout =
        WithAdvice(fmt::format("in more than {:.0f} % of the frames, with {} of the file as up",
                               kPercent * kLyingFrames.check, Name(recording.up_axis)),
                   Remedy::kUpAxis);
    if (judgement_.AddBeyond(kLyingFrames, upside_down / frames,
                             "the body is upside down " + throughout)) {
      return;
    }
    judgement_.AddBeyond(kLyingFrames, lying / frames, "the trunk lies " + throughout);
  }

  // A height that was given beside the one that the markers tell.
  void JudgeHeight(bool is_far) {
    const double height = report_.person.height.value;
    if (height <= 0 || report_.person.height_deviation > 0) return;
    std::optional<HeightEstimate> estimate;
    try {
      const auto* track = is_far ? nullptr : &report_.result.trajectory.postures;
      estimate = EstimateHeight(report_.setup, *report_.input.reference, markers_, track);
    } catch (const Error&) {
      return;  // too few markers
    }
    if (kMeanDistance.IsBeyond(estimate->mean_distance)) return;  // no height explains the markers
    judgement_.AddBeyond(
        kHeight, std::abs(estimate->height / height - 1),
        fmt::format("the height is {:.2f} m ({}), but the markers are those of a person of "
                    "{:.2f} m",
                    height, report_.person.height.source, estimate->height));
  }

  const ConversionReport& report_;
  const MarkerSequence& markers_;
  const ConversionFigures& figures_;
  const std::vector<Limb> limbs_;
  VerdictReasons judgement_;
};

constexpr const char* kLevelNames[] = {"good", "check", "failed"};

}  // namespace

const char* Name(Verdict::Level level) { return kLevelNames[static_cast<int>(level)]; }

Verdict::Level ParseVerdictLevel(const std::string& text) {
  for (const Level level : {Level::kGood, Level::kCheck, Level::kFailed}) {
    if (text == Name(level)) return level;
  }
  throw Error(fmt::format("unknown verdict \"{}\"; good, check or failed", text));
}

std::string DescribeVerdict(const Verdict& verdict) {
  std::string text = Name(verdict.level);
  if (!verdict.reasons.empty()) text += fmt::format(": {}", fmt::join(verdict.reasons, "; "));
  return text;
}

Verdict JudgeConversion(const ConversionReport& report) { return Judge(report).Run(); }

Verdict JudgeCalibration(const CalibrationReport& report, const ConverterConfig& config) {
  VerdictReasons judgement;
  const CalibrationResult& result = report.result;
  bool is_far = judgement.AddBeyond(
      kMeanDistance, result.distance_before,
      fmt::format("before calibration, markers are {:.0f} mm from the model on average, those of "
                  "a person of that height at most {:.0f}",
                  kMillimetres * result.distance_before, kMillimetres * kMeanDistance.check));
  is_far |= judgement.AddBeyond(
      kCalibratedMeanDistance, result.distance_after,
      fmt::format("after calibration, markers are still {:.0f} mm from the model, those of a "
                  "person at most {:.0f}",
                  kMillimetres * result.distance_after,
                  kMillimetres * kCalibratedMeanDistance.check));
  is_far |= JudgeOffsets(result.subject, &judgement);
  for (const CalibrationInput& one : report.recordings) {
    const Recording& recording = one.input.recording;
    JudgeReading(recording, &judgement);
    JudgeCoverage(one.setup, LimbsOf(one.setup), &judgement);
    JudgeNoise(one.setup, recording.markers, &judgement);
    if (is_far) {
      JudgeSides(one.setup, one.input.reference, ScalingOf(report.person, config),
                 recording.markers, &judgement);
    }
  }
  return judgement.Take();
}

}  // namespace mmm_converter
