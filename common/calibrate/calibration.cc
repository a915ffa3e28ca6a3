// SPDX-License-Identifier: MIT
#include "common/calibrate/calibration.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "common/calibrate/body_fit.h"
#include "common/calibrate/body_kinematics.h"
#include "common/calibrate/calibration_frames.h"
#include "common/calibrate/joint_doubts.h"
#include "common/math/statistics.h"
#include "common/model/joint_limits.h"
#include "common/support/error.h"
#include "common/support/units.h"

namespace mmm_converter {

using Eigen::VectorXd;

namespace {

constexpr int kLeastMarkers = 10;
constexpr double kLeastSeenShare = 0.5;
// Candidate frames are 0.1 s apart.
constexpr int kLeastFrames = 20;
// A joint that moves less than this tells nothing of where its axis is [rad].
constexpr double kLeastRange = 0.2;
// A recording in which no joint moves more than this is one of standing still [rad].
constexpr double kStillRange = 0.35;
constexpr double kLeastObservability = 0.5;
// Wands included, nobody wears a marker farther than this from where the model has it [m].
constexpr double kFarOffset = 0.2;

// So many markers of a recording that are this far from their place in all were attached again [m].
constexpr double kMovedMarker = 0.005;
constexpr double kMovedShare = 0.25;

std::string Advice() {
  return "record some ten seconds in which shoulders, elbows, spine, hips and knees bend, most "
         "markers seen";
}

void CheckCount(const std::vector<MarkerIx>& markers) {
  if (static_cast<int>(markers.size()) >= kLeastMarkers) return;
  throw Error(fmt::format("{} markers are assigned; a calibration needs at least {}",
                          markers.size(), kLeastMarkers));
}

std::vector<CalibrationFrame> FramesOf(const std::vector<CalibrationRecording>& recordings,
                                       const std::vector<MarkerIx>& markers, int least_frames) {
  const auto count = static_cast<int>(markers.size());
  const int least_seen = std::max(kLeastMarkers, static_cast<int>(kLeastSeenShare * count));
  std::vector<CalibrationFrame> frames = CandidateFrames(recordings, markers, least_seen);
  if (static_cast<int>(frames.size()) < least_frames) {
    throw Error(fmt::format(
        "too short to calibrate on: {} frames at least 0.1 s apart show {} of the {} assigned "
        "markers, {} are needed; {}",
        frames.size(), least_seen, count, least_frames, Advice()));
  }
  return frames;
}

/// How far each joint moves in the middle 90 % of the frames, of one recording or all together, the
/// most [rad]: a short movement counts beside long standing, and so do several postures.
VectorXd JointRanges(const std::vector<CalibrationFrame>& frames) {
  VectorXd ranges = VectorXd::Zero(frames.front().posture.joint_angles.size());
  std::vector<double> angles;
  const auto extend = [&](auto begin, auto end) {
    angles.resize(end - begin);
    for (Eigen::Index j = 0; j < ranges.size(); ++j) {
      std::transform(begin, end, angles.begin(),
                     [&](const auto& one) { return one.posture.joint_angles[j]; });
      ranges[j] = std::max(ranges[j], Percentile(angles, 95) - Percentile(angles, 5));
    }
  };
  extend(frames.begin(), frames.end());
  for (auto begin = frames.begin(); begin != frames.end();) {
    const auto end = std::find_if(
        begin, frames.end(), [&](const auto& one) { return one.recording != begin->recording; });
    extend(begin, end);
    begin = end;
  }
  return ranges;
}

/// Whether the person moves at all.
bool CheckMovement(const KinematicModel& model, const std::vector<int>& joints,
                   const std::vector<CalibrationFrame>& frames, bool may_stand,
                   Warnings* warnings) {
  const VectorXd ranges = JointRanges(frames);
  Eigen::Index widest = 0;
  if (ranges.maxCoeff(&widest) < kStillRange) {
    if (may_stand) {
      Warn(warnings,
           "the person only stands: joint angles of this posture are the model's by its markers, "
           "and "
           "where joints turn is the model's, too; a recording with movement tells more");
      return false;
    }
    throw Error(fmt::format(
        "too still to calibrate on: the joint that moves most, {}, does so by {:.0f} degrees, at "
        "least {:.0f} are needed to tell where markers sit from how the person stands; {}",
        model.joint(joints[widest]).name, kDegrees * ranges[widest], kDegrees * kStillRange,
        Advice()));
  }
  const auto still = (ranges.array() < kLeastRange).count();
  if (still > 0) {
    Warn(warnings, fmt::format("{} of {} joints move by less than {:.0f} degrees: what sits around "
                               "them stays near the "
                               "model's",
                               still, ranges.size(), kDegrees * kLeastRange));
  }
  return true;
}

VectorXd NoiseScales(const std::vector<CalibrationRecording>& recordings,
                     const std::vector<MarkerIx>& markers) {
  VectorXd scales = VectorXd::Ones(static_cast<Eigen::Index>(markers.size()));
  for (const CalibrationRecording& recording : recordings) {
    for (const MarkerAssignment& assignment : recording.assignments) {
      const auto found = std::lower_bound(markers.begin(), markers.end(), assignment.marker);
      scales[found - markers.begin()] = assignment.noise_scale;
    }
  }
  return scales;
}

bool IsEverSeen(const std::vector<CalibrationFrame>& frames, Eigen::Index marker) {
  return std::any_of(frames.begin(), frames.end(),
                     [&](const auto& frame) { return IsSeen(frame.z.col(marker)); });
}

void LeaveOutUnseen(const std::vector<CalibrationFrame>& frames, Body* body) {
  for (Eigen::Index m = 0; m < body->offsets.cols(); ++m) {
    if (!IsEverSeen(frames, m)) body->offsets.col(m).setZero();
  }
}

Subject MakeSubject(const BodyKinematics& kinematics, const Body& body, const BodyFitResult& fit,
                    const std::vector<CalibrationFrame>& frames, const VectorXd& place_deviations) {
  Subject subject;
  const KinematicModel& model = kinematics.model();
  subject.model = model.name();
  for (Eigen::Index i = 0; i < body.scales.size(); ++i) {
    subject.scales.push_back({LengthName(model, kinematics.lengths(), static_cast<int>(i)),
                              body.scales[i], fit.deviations.scales[i],
                              fit.prior_scale_deviations[i]});
  }
  for (Eigen::Index m = 0; m < body.offsets.cols(); ++m) {
    const auto seen = std::count_if(frames.begin(), frames.end(),
                                    [&](const auto& frame) { return IsSeen(frame.z.col(m)); });
    if (seen == 0) continue;
    MarkerOffset offset;
    offset.marker = model.markers()[kinematics.markers()[m]].name;
    offset.offset = body.offsets.col(m);
    offset.standard_deviations = fit.deviations.offsets.col(m);
    offset.prior_deviation = place_deviations[m];
    offset.frames = static_cast<int>(seen);
    subject.offsets.push_back(offset);
  }
  subject.joints = FindJointDoubts(kinematics, fit);
  return subject;
}

void AddSkinDeviations(const KinematicModel& fitted, const std::vector<int>& joints,
                       const std::vector<MarkerIx>& markers,
                       const std::vector<CalibrationFrame>& frames, Subject* subject) {
  const VectorXd deviations = SkinDeviations(fitted, joints, markers, frames);
  for (std::size_t m = 0; m < markers.size(); ++m) {
    for (MarkerOffset& offset : subject->offsets) {
      if (offset.marker != fitted.markers()[markers[m]].name) continue;
      offset.skin_deviation = deviations[static_cast<Eigen::Index>(m)];
    }
  }
}

/// The segments of which the recordings tell no length, or no axis.
std::vector<std::string> OpenLengths(const BodyKinematics& kinematics, const Subject& subject) {
  const SegmentLengths& lengths = kinematics.lengths();
  const std::size_t axes = lengths.are_of_axes ? 3 : 1;
  std::vector<std::string> open;
  for (std::size_t i = 0; i < subject.scales.size(); i += axes) {
    double most = 0;
    for (std::size_t axis = i; axis < i + axes; ++axis) {
      const SegmentScale& scale = subject.scales[axis];
      most = std::max(most, Observability(scale.standard_deviation, scale.prior_deviation));
    }
    if (most >= kLeastObservability) continue;
    open.push_back(kinematics.model().segments()[lengths.segments[i]].name);
  }
  return open;
}

void WarnOfSubject(const BodyKinematics& kinematics, const Subject& subject, Warnings* warnings) {
  const std::vector<std::string> open = OpenLengths(kinematics, subject);
  if (!open.empty()) {
    Warn(warnings, fmt::format("the recordings tell little of the length of {}: their markers or "
                               "movements do not show it",
                               fmt::join(open, ", ")));
  }
  for (const MarkerOffset& offset : subject.offsets) {
    if (offset.offset.norm() > kFarOffset) {
      Warn(warnings,
           fmt::format(
               "{} sits {:.0f} mm from where the model has it; is it the marker of that name?",
               offset.marker, 1000 * offset.offset.norm()));
    }
  }
}

std::vector<MovedMarkers> FindMoved(const KinematicModel& fitted, const std::vector<int>& joints,
                                    const std::vector<MarkerIx>& markers,
                                    const std::vector<CalibrationRecording>& recordings,
                                    const std::vector<CalibrationFrame>& frames) {
  std::vector<MovedMarkers> found;
  for (std::size_t r = 0; r < recordings.size() && recordings.size() > 1; ++r) {
    std::vector<CalibrationFrame> own;
    std::copy_if(frames.begin(), frames.end(), std::back_inserter(own),
                 [&](const auto& frame) { return frame.recording == static_cast<int>(r); });
    if (own.empty()) continue;
    const Eigen::Matrix3Xd shifts = MedianResiduals(fitted, joints, markers, own);
    const auto moved = (shifts.colwise().norm().array() > kMovedMarker).count();
    if (static_cast<double>(moved) < kMovedShare * static_cast<double>(shifts.cols())) continue;
    found.push_back({recordings[r].name, static_cast<int>(moved), static_cast<int>(shifts.cols()),
                     kMovedMarker});
  }
  return found;
}

/// Knees that may bend backwards, as those of some people do. Landmarks tell that they do; where
/// places are hardly known, that knees do not tells of the places.
KinematicModel WithFreeKnees(const KinematicModel& model) {
  constexpr double kBackwards = 15 / kDegrees;
  KinematicModel free_model = model;
  for (const char* knee : {"LKx_joint", "RKx_joint"}) {
    const int joint = model.FindJoint(knee);
    if (joint < 0) continue;
    free_model = WithUpperLimit(free_model, joint, model.joint(joint).upper + kBackwards);
  }
  return free_model;
}

}  // namespace

CalibrationResult CalibrateSubject(const KinematicModel& model, const std::vector<int>& joints,
                                   const std::vector<CalibrationRecording>& recordings,
                                   const CalibrationOptions& options, Warnings* warnings) {
  const std::vector<MarkerIx> markers = UsedMarkers(recordings);
  const KinematicModel own = options.places_by_noise ? WithFreeKnees(model) : model;
  BodyKinematics kinematics(own, joints, markers);
  return CalibrateBody(&kinematics, recordings, options, warnings);
}

CalibrationResult CalibrateBody(BodyKinematics* kinematics,
                                const std::vector<CalibrationRecording>& recordings,
                                const CalibrationOptions& options, Warnings* warnings) {
  const KinematicModel& model = kinematics->model();
  const std::vector<int>& joints = kinematics->joints();
  const std::vector<MarkerIx>& markers = kinematics->markers();
  CheckCount(markers);
  std::vector<CalibrationFrame> frames =
      FramesOf(recordings, markers, options.may_stand ? 1 : kLeastFrames);
  Body body = kinematics->ModelBody();
  CalibrationResult result;
  const OffsetsInTurns first =
      FitOffsetsInTurns(model, joints, markers, &frames, options.between_steps);
  result.stands = !CheckMovement(model, joints, frames, options.may_stand, warnings);
  body.offsets = first.offsets;
  const VectorXd noise_scales = NoiseScales(recordings, markers);
  if (options.places_by_noise) {
    FitPosturesByPlaces(model, joints, markers, noise_scales, &frames, options.between_steps);
  }
  std::vector<CalibrationFrame> chosen = ChooseFrames(frames, first.distance, options.frames);
  // The median offsets of a posture that is not known are no better start than known places.
  if (options.places_by_noise) {
    body.offsets.setZero();
    for (CalibrationFrame& frame : chosen) frame.posture = frame.by_places;
  }
  const BodyFitResult fit = FitBody(kinematics, options, noise_scales, &chosen, &body);

  result.subject =
      MakeSubject(*kinematics, body, fit, chosen, PlaceDeviations(options, noise_scales));
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    const auto taken = std::count_if(chosen.begin(), chosen.end(), [&](const auto& frame) {
      return frame.recording == static_cast<int>(r);
    });
    result.subject.sources.push_back({recordings[r].name, static_cast<int>(taken)});
  }
  WarnOfSubject(*kinematics, result.subject, warnings);
  if (!fit.converged) {
    Warn(warnings, fmt::format("the estimate was still changing after {} steps; a recording with "
                               "more movement settles "
                               "it",
                               fit.iterations));
  }
  LeaveOutUnseen(chosen, &body);
  kinematics->SetBody(body);
  const KinematicModel& fitted = kinematics->fitted();
  result.distance_before = first.distance_before.mean();
  result.distance_after =
      FitPostures(fitted, joints, markers, &frames, options.between_steps).mean();
  AddSkinDeviations(fitted, joints, markers, frames, &result.subject);
  result.moved = FindMoved(fitted, joints, markers, recordings, frames);
  result.frames = static_cast<int>(chosen.size());
  result.iterations = fit.iterations;
  result.side_correlation = fit.side_correlation;
  return result;
}

}  // namespace mmm_converter
