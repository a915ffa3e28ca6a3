// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/conversion/verdict.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "MMMConverterS2KF/conversion/conversion.h"
#include "MMMConverterS2KF/conversion/conversion_figures.h"
#include "MMMConverterS2KF/conversion/coverage.h"
#include "common/convert/exchanged_sides.h"
#include "common/fit/rigid_shape.h"
#include "common/math/statistics.h"
#include "common/motion/marker_noise.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

using Level = Verdict::Level;

// A figure beyond the first is to be looked at, one beyond the second can't be right.
struct Limit {
  double check, failed;

  bool IsBeyond(double value) const { return value > check; }  // NaN is not
  Level LevelOf(double value) const { return value > failed ? Level::kFailed : Level::kCheck; }
};

constexpr double kNever = std::numeric_limits<double>::infinity();

// Right is what the recordings at hand have, real and synthetic, 10 to 120 Hz; the others were made
// wrong from three of them. Distances in metres. tests/cli/verdict_test.cc has a case of each kind.
//
// Distances on average: right 0.025 to 0.045 (markers sit 0.028 off on each axis); left and right
// exchanged or mirrored 0.055 to 0.12, grossly wrong 0.13 and more.
constexpr Limit kMean = {0.055, 0.15};
// Their 95th percentile: right 0.05 to 0.11; legs exchanged 0.19, others' markers 0.5 to 1.8.
constexpr Limit kPercentile = {0.15, 0.4};
// The same of a calibrated person: right 0.002 to 0.009 and 0.006 to 0.024.
constexpr Limit kCalibratedMean = {0.02, 0.06};
constexpr Limit kCalibratedPercentile = {0.06, 0.2};
// The average of one marker: right at most 0.18; another person's 1.1 to 1.7.
constexpr Limit kMarkerMean = {0.22, 0.6};
// Offsets of calibrated markers, the 95th percentile: right 0.06 to 0.16; legs exchanged 0.19.
constexpr Limit kOffset = {0.18, 0.4};
// A height beside the estimated one, relative, which is within 0.035 of the true one.
constexpr Limit kHeight = {0.08, 0.2};
// Share of the frames: right at most 0.06; left and right exchanged 0.1 to 0.8.
constexpr Limit kReassembled = {0.1, 0.5};
// Share of the seen positions: right at most 0.001; legs exchanged 0.02.
constexpr Limit kWrongLabels = {0.01, 0.2};
// Of a capture below 0.001.
constexpr Limit kNoise = {0.003, 0.03};
// Of the six limbs: none, and half of the body.
constexpr Limit kUnseenLimbs = {0, 2};
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
    JudgeReading();
    if (report_.object) {
      JudgeObjectsDistance();
      JudgeGaps();
      return TakeVerdict();
    }
    const bool is_far = JudgeDistances();
    JudgeMarkers();
    JudgeCoverage();
    JudgeGaps();
    JudgeTrack();
    JudgeNoise();
    JudgeUpright();
    JudgeHeight(is_far);
    if (is_far) JudgeSides();
    return TakeVerdict();
  }

 private:
  void Add(Level level, std::string reason) { reasons_.emplace_back(level, std::move(reason)); }

  // The gravest reasons first.
  Verdict TakeVerdict() {
    std::stable_sort(reasons_.begin(), reasons_.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    Verdict verdict;
    if (!reasons_.empty()) verdict.level = reasons_.front().first;
    for (auto& [unused, reason] : reasons_) verdict.reasons.push_back(std::move(reason));
    return verdict;
  }

  // Adds the reason where a figure is beyond its limit.
  bool AddBeyond(const Limit& limit, double value, const std::string& reason) {
    if (!limit.IsBeyond(value)) return false;
    Add(limit.LevelOf(value), reason);
    return true;
  }

  std::string LabelsOf(const std::vector<int>& assignments) const {
    std::vector<std::string> labels;
    for (const int i : assignments) labels.push_back(LabelOf(report_, i));
    return FirstNames(labels, 6);
  }

  void JudgeReading() {
    for (const std::string& doubt : report_.input.recording.doubts) {
      Add(Level::kCheck, doubt);
    }
  }

  void JudgeObjectsDistance() {
    Eigen::Matrix3Xd places(3, static_cast<Eigen::Index>(report_.setup.assignments().size()));
    for (Eigen::Index i = 0; i < places.cols(); ++i) {
      const int marker = report_.setup.assignments()[static_cast<std::size_t>(i)].marker;
      places.col(i) = report_.setup.model->markers()[marker].p_SM;
    }
    const double radius = RadiusOf(places);
    AddBeyond(kObject, figures_.distance.mean / radius,
              fmt::format("the markers are {:.1f} mm from the model, whose radius is {:.0f} mm",
                          1e3 * figures_.distance.mean, 1e3 * radius));
  }

  // Whether the markers are farther from the model than a person's are.
  bool JudgeDistances() {
    const bool is_calibrated = report_.person.subject != nullptr;
    const Limit& mean = is_calibrated ? kCalibratedMean : kMean;
    const Limit& percentile = is_calibrated ? kCalibratedPercentile : kPercentile;
    const char* person = is_calibrated ? "a calibrated person" : "a person of that height";
    bool is_far = AddBeyond(mean, figures_.distance.mean,
                            fmt::format("markers are {:.0f} mm from the model on average, those of "
                                        "{} at most {:.0f}",
                                        1e3 * figures_.distance.mean, person, 1e3 * mean.check));
    is_far |=
        AddBeyond(percentile, figures_.distance.p95,
                  fmt::format("one in twenty marker positions is more than {:.0f} mm from the "
                              "model, of {} at most {:.0f}",
                              1e3 * figures_.distance.p95, person, 1e3 * percentile.check));
    if (!is_calibrated) return is_far;
    std::vector<double> offsets;
    for (const MarkerOffset& offset : report_.person.subject->offsets) {
      offsets.push_back(offset.offset.norm());
    }
    const double most = Percentile(offsets, 95);
    is_far |= AddBeyond(
        kOffset, most,
        fmt::format("one in twenty markers sits more than {:.0f} mm from where the model has it, "
                    "of a person of that height at most {:.0f}",
                    1e3 * most, 1e3 * kOffset.check));
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
    AddBeyond(kMarkerMean, most,
              fmt::format("{} of {} markers are on average more than {:.0f} mm from where the body "
                          "can have them: {}; are they this person's?",
                          far.size(), figures_.of_markers.size(), 1e3 * kMarkerMean.check,
                          LabelsOf(far)));
  }

  void JudgeCoverage() {
    std::vector<std::string> unseen;
    for (const Limb& limb : limbs_) {
      if (!limb.IsKnownBy(static_cast<int>(limb.labels.size()))) {
        unseen.push_back(fmt::format("the {} ({} markers)", limb.name, limb.labels.size()));
      } else if (limb.free_joints > 0) {
        Add(Level::kCheck, fmt::format("{}: no marker shows {} of its {} joints", limb.name,
                                       limb.free_joints, limb.num_joints));
      }
    }
    AddBeyond(kUnseenLimbs, static_cast<double>(unseen.size()),
              fmt::format("too few markers to know {}", JoinNames(unseen, " and ")));
    const auto coordinates = 3 * report_.setup.assignments().size();
    const auto degrees = 6 + report_.setup.joints.size();
    if (coordinates >= degrees) return;
    Add(Level::kCheck,
        fmt::format("{} markers are too few for the {} degrees of freedom of the body",
                    report_.setup.assignments().size(), degrees));
  }

  void JudgeGaps() {
    for (const Gap& gap : LongGaps(report_.setup, limbs_, markers_)) {
      Add(Level::kCheck, fmt::format("{} is hidden for {:.1f} s, frames {} to {}", gap.what,
                                     gap.seconds, report_.input.first_frame + gap.first_frame,
                                     report_.input.first_frame + gap.last_frame));
    }
  }

  void JudgeTrack() {
    const double frames = markers_.num_frames();
    AddBeyond(kReassembled, figures_.frames_reassembled / frames,
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
    AddBeyond(kWrongLabels, share,
              fmt::format("{:.0f} % of the marker positions are not where their labels belong: {}",
                          1e2 * share, LabelsOf(assignments)));
  }

  void JudgeNoise() {
    const double noise = MeasureMarkerNoise(markers_, LabelIndices(report_.setup.assignments()));
    AddBeyond(kNoise, noise,
              fmt::format("marker positions have noise of {:.1f} mm, a capture less than 1",
                          1e3 * noise));
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
    const std::string throughout = fmt::format(
        "in more than {:.0f} % of the frames, with {} of the file as up; is that axis right?",
        1e2 * kLyingFrames.check, Name(recording.up_axis));
    if (AddBeyond(kLyingFrames, upside_down / frames, "the body is upside down " + throughout)) {
      return;
    }
    AddBeyond(kLyingFrames, lying / frames, "the trunk lies " + throughout);
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
    if (kMean.IsBeyond(estimate->mean_distance)) return;  // no height explains the markers
    AddBeyond(kHeight, std::abs(estimate->height / height - 1),
              fmt::format("the height is {:.2f} m ({}), but the markers are those of a person of "
                          "{:.2f} m",
                          height, report_.person.height.source, estimate->height));
  }

  void JudgeSides() {
    TrackingSetup setup = report_.setup;  // without the subject, whose markers may have taken it up
    setup.model = report_.input.reference;
    PersonScaling person = ScalingOf(report_.person, report_.converter.config);
    person.subject = nullptr;
    ScaleToPerson(person, &setup);
    const auto exchanged = FindExchangedSides(setup, markers_);
    if (!exchanged) return;
    Add(Level::kFailed,
        fmt::format("left and right labels of {} are exchanged, or coordinates mirrored: "
                    "exchanged, markers are {:.0f} mm from the model, else {:.0f}",
                    exchanged->part, 1e3 * exchanged->exchanged_distance,
                    1e3 * exchanged->distance));
  }

  const ConversionReport& report_;
  const MarkerSequence& markers_;
  const ConversionFigures& figures_;
  const std::vector<Limb> limbs_;
  std::vector<std::pair<Level, std::string>> reasons_;
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

}  // namespace mmm_converter
