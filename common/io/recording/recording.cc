// SPDX-License-Identifier: MIT
#include "common/io/recording/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "common/io/mmm/mmm_content.h"
#include "common/io/recording/marker_labels.h"
#include "common/io/recording/recording_axes.h"
#include "common/io/recording/recording_formats.h"
#include "common/motion/held_markers.h"
#include "common/support/error.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr double kStillPelvis = 0.001, kMovedFeet = 0.05;  // [m] who breathes moves by more

bool SeesAnything(const MarkerSequence& markers) {
  for (int k = 0; k < markers.num_frames(); ++k) {
    if (!markers.frame(k).array().isNaN().all()) return true;
  }
  return false;
}

[[noreturn]] void ThrowSeesNothing(const std::string& file, bool marks_points_valid) {
  if (!marks_points_valid) {
    throw Error(fmt::format("{}: no marker is seen in any frame", file));
  }
  throw Error(fmt::format("{}: no marker is marked valid in any frame; if they are good "
                          "nevertheless, ignore the marks",
                          file),
              Remedy::kIgnoreResiduals);
}

/// By label: whether any frame shows it.
std::vector<bool> SeenLabels(const MarkerSequence& markers) {
  std::vector<bool> seen(static_cast<std::size_t>(markers.num_labels()));
  for (int k = 0; k < markers.num_frames(); ++k) {
    for (int i = 0; i < markers.num_labels(); ++i) {
      if (IsSeen(markers.frame(k).col(i))) seen[static_cast<std::size_t>(i)] = true;
    }
  }
  return seen;
}

/// Some of them, under new labels.
MarkerSequence Chosen(const MarkerSequence& all, const std::vector<int>& points,
                      const std::vector<std::string>& labels) {
  MarkerSequence chosen(labels, all.num_frames(), all.rate(), all.first_time());
  for (int k = 0; k < all.num_frames(); ++k) chosen.frame(k) = all.frame(k)(Eigen::all, points);
  return chosen;
}

/// @throws Error where it is none.
double RateOf(const RecordingContent& content, const ReadRecordingOptions& options,
              const Recording* recording) {
  const double rate = options.rate.value_or(content.rate);
  if (!(rate > 0 && std::isfinite(rate))) {
    throw Error(fmt::format("{}: gives no frame rate; give it", recording->file), Remedy::kRate);
  }
  if (!IsFrameRate(rate)) {
    throw Error(fmt::format("{}: gives a frame rate of {:.6g} Hz, which is outside {:.0f} to "
                            "{:.0f} Hz; give the right one",
                            recording->file, rate, kLowestRate, kHighestRate),
                Remedy::kRate);
  }
  return rate;
}

/// The markers of one subject.
void ChooseMarkers(const RecordingContent& content, const ReadRecordingOptions& options,
                   Recording* recording, Warnings* warnings) {
  const double rate = RateOf(content, options, recording);
  std::optional<MarkerSequence> all;  // where it takes all to choose
  const auto are_seen = [&] {
    std::vector<int> points(content.labels.size());
    std::iota(points.begin(), points.end(), 0);
    std::vector<std::string> names;
    names.reserve(points.size());
    for (const int point : points) names.push_back(fmt::format("{}", point));
    all = content.read(points, names, rate);
    return SeenLabels(*all);
  };
  const LabelSelection selection =
      options.all_subjects
          ? SelectAllSubjects(content.labels, content.outputs, content.label_prefixes, warnings)
          : SelectLabels(content.labels, content.outputs, content.label_prefixes, options.subject,
                         recording->file, warnings, options.with_unlabelled, are_seen);
  recording->subjects = selection.subjects;
  recording->subject = selection.subject;
  if (selection.labels.empty()) {
    throw Error(fmt::format("{}: there are no labelled markers", recording->file), Remedy::kLabels);
  }
  recording->points = selection.indices;
  recording->markers = all ? Chosen(*all, selection.indices, selection.labels)
                           : content.read(selection.indices, selection.labels, rate);
  if (!SeesAnything(recording->markers)) {
    ThrowSeesNothing(recording->file, content.marks_points_valid);
  }
}

/// All joints and points of a skeleton that is a body's.
void TakeBody(const RecordingContent& content, const ReadRecordingOptions& options,
              Recording* recording) {
  recording->points.resize(content.labels.size());
  std::iota(recording->points.begin(), recording->points.end(), 0);
  recording->markers =
      content.read(recording->points, content.labels, RateOf(content, options, recording));
  if (!SeesAnything(recording->markers)) ThrowSeesNothing(recording->file, false);
  recording->body = content.body;
  recording->subjects = content.persons;
  recording->subject = content.person;
  if (!content.doubt.empty() && !options.unit) {
    recording->doubts.push_back({content.doubt, Remedy::kUnit});
  }
}

/// Joints of a body under the names of landmarks that are nearby.
MarkerSequence LandmarksOf(const std::vector<SkeletonJoint>& body, const MarkerSequence& markers) {
  constexpr std::pair<BodyJoint, const char*> kLandmarks[] = {
      {BodyJoint::kHead, "HEAD"},   {BodyJoint::kShoulder, "SHO"}, {BodyJoint::kHip, "ASI"},
      {BodyJoint::kPelvis, "SACR"}, {BodyJoint::kAnkle, "ANK"},    {BodyJoint::kToe, "TOE"},
      {BodyJoint::kWrist, "WRA"}};
  std::vector<std::string> labels;
  std::vector<int> chosen;
  for (const SkeletonJoint& one : body) {
    for (const auto& [joint, landmark] : kLandmarks) {
      if (one.joint != joint) continue;
      labels.push_back(one.side + landmark);
      chosen.push_back(one.label);
    }
  }
  MarkerSequence landmarks(labels, markers.num_frames(), markers.rate(), 0);
  for (int k = 0; k < markers.num_frames(); ++k) {
    landmarks.frame(k) = markers.frame(k)(Eigen::all, chosen);
  }
  return landmarks;
}

/// From file units and axes to metres and z up.
void BringToMetresAndZUp(const RecordingContent& content, const ReadRecordingOptions& options,
                         Recording* recording, Warnings* warnings) {
  const bool is_body = !content.body.empty();
  const UnitDecision unit = options.unit ? ParseUnit(*options.unit)
                            : is_body ? UnitDecision{content.unit, content.metres, false, "", false}
                                      : DecideUnit(recording->markers, content.unit);
  recording->unit = unit.unit;
  recording->unit_was_guessed = unit.guessed;
  if (!unit.warning.empty()) Warn(warnings, unit.warning);
  if (unit.is_doubtful) recording->doubts.push_back({unit.warning, Remedy::kUnit});
  const UpAxisDecision up = DecideUpAxis(
      is_body ? LandmarksOf(content.body, recording->markers) : recording->markers, unit.metres,
      {options.up_axis, recording->stated_up_axis, content.usual_up_axes});
  recording->up_axis = up.axis;
  recording->up_axis_was_decided = up.decided;
  if (!up.warning.empty()) {
    Warn(warnings, up.warning);
  }
  if (!up.warning.empty() && up.is_doubtful) {
    recording->doubts.push_back({up.warning, Remedy::kUpAxis});
    recording->up_axis_is_doubtful = true;
  }
  ToMetresAndZUp(unit.metres, recording->up_axis, &recording->markers);
}

/// Of files that leave no choice.
void TakeSettled(const RecordingContent& content, const ReadRecordingOptions& options,
                 Recording* recording, Warnings* warnings) {
  recording->markers = content.read({}, content.labels, content.rate);
  recording->points.resize(content.labels.size());
  std::iota(recording->points.begin(), recording->points.end(), 0);
  recording->unit = content.unit;
  if (options.unit) {
    const std::string format = content.format.substr(0, content.format.find(' '));
    Warn(warnings, fmt::format("{} files are always in {}; the unit given is not used", format,
                               content.unit));
  }
  if (options.up_axis) {
    recording->up_axis = *options.up_axis;
    ToMetresAndZUp(1, recording->up_axis, &recording->markers);
  }
}

/// What was filled with a marker's last value is a gap.
void TakeOutHeldValues(Recording* recording, Warnings* warnings) {
  MarkerSequence& markers = recording->markers;
  for (const HeldStretch& held : FindHeldMarkers(markers)) {
    for (int k = held.begin; k < held.end; ++k) markers.frame(k).col(held.label).setConstant(kNaN);
    WarnOfKind(
        warnings, "gaps that were filled with the last value",
        fmt::format("{} stands still to the last digit in frames {} to {} while its "
                    "neighbours move, as where a gap is filled with the last value: taken "
                    "as not seen",
                    markers.labels()[static_cast<std::size_t>(held.label)],
                    recording->first_frame + held.begin, recording->first_frame + held.end - 1));
  }
}

/// Of a label's places, the diagonal of a box around them [m]; 0: it is nowhere seen.
double RangeOf(const MarkerSequence& markers, int label) {
  Eigen::AlignedBox3d box;
  for (int k = 0; k < markers.num_frames(); ++k) {
    const Eigen::Vector3d p = markers.frame(k).col(label);
    if (p.allFinite()) box.extend(p);
  }
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

/// Places relative to the pelvis, or a file without its translation.
void DoubtStillRoot(Recording* recording, Warnings* warnings) {
  double pelvis = INFINITY, feet = 0;
  for (const SkeletonJoint& joint : recording->body) {
    if (joint.joint == BodyJoint::kPelvis) {
      pelvis = std::min(pelvis, RangeOf(recording->markers, joint.label));
    }
    if (joint.joint == BodyJoint::kAnkle) {
      feet = std::max(feet, RangeOf(recording->markers, joint.label));
    }
  }
  if (!(pelvis < kStillPelvis) || feet < kMovedFeet) return;
  recording->doubts.push_back(
      {fmt::format("the pelvis never moves while a foot goes over {:.2f} m: the file has no motion "
                   "of the body in the world, only of its parts against the pelvis; export it with "
                   "the root's translation",
                   feet)});
  Warn(warnings, recording->doubts.back().text);
}

/// Who stands goes up and down by what the legs fold and stretch. A scaled armature may be exported
/// with bones and positions in different units.
void DoubtRootUnit(Recording* recording, Warnings* warnings) {
  constexpr double kAlike = 0.9, kTimes = 5;  // correlation; the least ratio of two units is 10
  constexpr double kLeastFold = 0.005;        // standard deviation [m], well above rounding
  int pelvis = -1;
  std::vector<int> feet;
  for (const SkeletonJoint& joint : recording->body) {
    if (joint.joint == BodyJoint::kPelvis) pelvis = joint.label;
    if (joint.joint == BodyJoint::kAnkle || joint.joint == BodyJoint::kToe) {
      feet.push_back(joint.label);
    }
  }
  if (pelvis < 0 || feet.empty()) return;
  std::vector<double> heights, reaches;
  for (int k = 0; k < recording->markers.num_frames(); ++k) {
    const auto p = recording->markers.frame(k);
    double low = INFINITY;
    for (const int foot : feet) low = std::min(low, p(2, foot));
    if (!std::isfinite(low) || !std::isfinite(p(2, pelvis))) continue;
    heights.push_back(p(2, pelvis));
    reaches.push_back(p(2, pelvis) - low);
  }
  if (heights.size() < 2) return;
  const auto centred = [](const std::vector<double>& values) {
    const auto all =
        Eigen::Map<const Eigen::ArrayXd>(values.data(), static_cast<Eigen::Index>(values.size()));
    return Eigen::VectorXd(all - all.mean());
  };
  const Eigen::VectorXd height = centred(heights), reach = centred(reaches);
  const double both = height.norm() * reach.norm();
  const double times = height.norm() / reach.norm();
  if (reach.norm() < kLeastFold * std::sqrt(static_cast<double>(reach.size()))) return;
  if (!(height.dot(reach) > kAlike * both) || (times < kTimes && times > 1 / kTimes)) return;
  recording->doubts.push_back(
      {fmt::format("the pelvis goes up and down {:.3g} times as far as the legs fold and stretch: "
                   "its positions are in another unit than the bones; export it with both in one",
                   times)});
  Warn(warnings, recording->doubts.back().text);
}

Recording MakeRecording(const std::string& file, RecordingContent content,
                        const ReadRecordingOptions& options, Warnings* warnings) {
  Recording recording;
  recording.file = file;
  recording.format = content.format;
  recording.first_frame = content.first_frame;
  recording.comment = std::move(content.comment);
  recording.origin = std::move(content.origin);
  recording.mmm = std::move(content.mmm);
  recording.stated_size = content.stated_size;
  const WarningContext context(warnings, file, recording.motion());
  if (content.is_settled) {
    TakeSettled(content, options, &recording, warnings);
  } else {
    if (content.body.empty()) {
      ChooseMarkers(content, options, &recording, warnings);
    } else {
      TakeBody(content, options, &recording);
    }
    if (!content.doubt_of_names.empty()) recording.doubts.push_back({content.doubt_of_names});
    recording.stated_up_axis = StatedUpAxis(content.stated_up);
    BringToMetresAndZUp(content, options, &recording, warnings);
  }
  if (recording.body.empty()) TakeOutHeldValues(&recording, warnings);
  DoubtStillRoot(&recording, warnings);
  DoubtRootUnit(&recording, warnings);
  if (content.declared_frames > recording.markers.num_frames()) {
    recording.doubts.push_back(
        {fmt::format("the file is cut off: it declares {} frames and holds {}",
                     content.declared_frames, recording.markers.num_frames())});
  }
  return recording;
}

}  // namespace

Recording ReadRecording(const std::string& path, const ReadRecordingOptions& options,
                        Warnings* warnings) {
  if (options.rate && !IsFrameRate(*options.rate)) {
    throw Error(fmt::format("a frame rate of {:.6g} Hz; it must be {:.0f} to {:.0f} Hz",
                            *options.rate, kLowestRate, kHighestRate));
  }
  const RecordingFormat& format = FormatOfContent(path);
  return MakeRecording(path,
                       format.read(path,
                                   {options.ignore_residuals, options.motion, options.smpl_model,
                                    options.subject, options.all_subjects},
                                   warnings),
                       options, warnings);
}

std::vector<WithWarnings<Recording>> ReadAllMotions(const std::string& path,
                                                    const ReadRecordingOptions& options,
                                                    Warnings* warnings) {
  const RecordingFormat* format = FindFormatOfContent(path);
  if (format == nullptr || !format->holds_motions) {
    throw Error(
        fmt::format("{}: is not an MMM motion file; only these have several motions", path));
  }
  std::vector<RecordingContent> contents = ReadAllMmmContents(path, warnings);
  std::vector<WithWarnings<Recording>> recordings(contents.size());
  for (std::size_t i = 0; i < contents.size(); ++i) {
    recordings[i].value =
        MakeRecording(path, std::move(contents[i]), options, &recordings[i].warnings);
  }
  return recordings;
}

}  // namespace mmm_converter
