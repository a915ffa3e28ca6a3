// SPDX-License-Identifier: MIT
#include "common/pipeline/ground_study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/contacts/person_mass.h"
#include "common/contacts/plate_readings.h"
#include "common/contacts/stored_events.h"
#include "common/forces/emg.h"
#include "common/forces/recording_forces.h"
#include "common/kinetics/foot_wrenches.h"
#include "common/kinetics/moment_deviations.h"
#include "common/math/statistics.h"
#include "common/motion/anatomical_angles.h"
#include "common/motion/marker_residuals.h"
#include "common/pipeline/conversion.h"
#include "common/pipeline/gait_forces.h"
#include "common/study/coverage.h"
#include "common/support/advice.h"
#include "common/support/error.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

/// Those of a trajectory whose first `begin` frames are left out.
std::vector<PoseCovariance> CovariancesFrom(int begin, const ConversionResult& result) {
  std::vector<PoseCovariance> covariances = result.covariances;
  for (PoseCovariance& one : covariances) one.frame -= begin;
  return covariances;
}

/// A model whose segments are as many times as heavy as the person is.
KinematicModel WithMass(const KinematicModel& model, double mass) {
  if (mass == model.total_mass()) return model;
  ModelDescription description = DescriptionOf(model);
  const double scale = mass / model.total_mass();
  for (Segment& segment : description.segments) {
    segment.mass *= scale;
    segment.inertia *= scale;
  }
  return KinematicModel(std::move(description));
}

/// Whether it is told by plates, or by a leg that is seen where it begins or for most of it.
bool IsTold(const FootContact& contact, const FootMotion& feet, const KnownLegs& known) {
  const std::vector<bool>& leg = known[static_cast<std::size_t>(contact.side)];
  const int last = feet.num_frames() - 1;
  const int from = contact.begin ? feet.frame(*contact.begin) : 0;
  const int to = contact.end ? feet.frame(*contact.end) : last;
  if (!contact.plates.empty() || to < from) return !contact.plates.empty();
  if (contact.begin && leg[static_cast<std::size_t>(feet.frame(*contact.begin - kSeenBeside))] &&
      leg[static_cast<std::size_t>(from)]) {
    return true;
  }
  return 2 * std::count(leg.begin() + from, leg.begin() + to + 1, true) > to - from;
}

constexpr double kToldDeviation = 0.01;           // [s] of events by plates or by a file
constexpr double kMostTimes = 1.5;                // of a stated mass: what people carry is less
constexpr double kLightest = 8, kHeaviest = 250;  // [kg] persons who walk

std::string PartOf(const PlateLoad& load) {
  const char* foot = Name(load.bearer);
  if (load.beside[0] > 0 && load.beside[1] > 0) return fmt::format("{} foot", foot);
  return fmt::format("{} foot's {}", foot, load.beside[0] > 0 ? "heel" : "toes");
}

/// Of feet that are on a plate with a part of them.
void WarnOfParts(const Contacts& contacts, const RecordedForces& forces, Warnings* warnings) {
  for (const PlateLoad& load : contacts.loads) {
    if (!load.is_part_of_foot) continue;
    const char* event = load.begins_late ? (load.ends_early ? "comes and goes" : "comes") : "goes";
    const std::string told = load.begins_late || load.ends_early
                                 ? fmt::format("when it {} is by its motion, and ", event)
                                 : "";
    Warn(warnings,
         fmt::format("force plate {}: the {} rest{} some {:.0f} mm beside it from {:.2f} to {:.2f} "
                     "s: it bears a part of the foot; {}forces and moments of this step are left "
                     "out",
                     forces.plates[load.plate].plate.number, PartOf(load),
                     load.beside[1] > 0 && load.beside[0] == 0 ? "" : "s",
                     kMillimetres * Max(load.beside), load.begin, load.end, told));
  }
}

/// A table of other times tells nothing, and is as long as it likes.
void CheckIsOfRecording(const RecordedForces& forces, const Input& input) {
  const MarkerSequence& markers = input.recording.markers;
  if (forces.plates.empty() || markers.num_frames() == 0) return;
  const auto rows = static_cast<double>(forces.plates.front().force.cols());
  const double last = forces.first_time + (rows - 1) / forces.rate;
  const double end = markers.time(markers.num_frames() - 1);
  const double frame = 1 / markers.rate();
  if (forces.first_time <= end + frame && last >= markers.first_time() - frame) return;
  throw Error(
      fmt::format("{}: its forces are of {:g} s to {:g} s, the recording's frames of {:g} s "
                  "to {:g} s; they have to be of one recording and begin alike",
                  input.forces_file, forces.first_time, last, markers.first_time(), end));
}

}  // namespace

std::string DoubtOfScale(const std::optional<MassByPlates>& borne, const PersonValue& stated) {
  if (!borne) return "";
  const bool is_stated = stated.value > 0 && !IsAssumed(stated) && !IsByPlates(stated);
  const bool is_far =
      is_stated ? std::max(borne->mass / stated.value, stated.value / borne->mass) > kMostTimes
                : borne->mass < kLightest || borne->mass > kHeaviest;
  if (!is_far) return "";
  return fmt::format(
      "the force plates bore {:.3g} kg{}: their forces are of another scale", borne->mass,
      is_stated ? fmt::format(", the person's mass is {:.3g} kg ({})", stated.value, stated.source)
                : "");
}

KnownLegs FindKnownLegs(const ConversionReport& report) {
  const Eigen::MatrixXd& residuals = report.result.residuals;
  KnownLegs known;
  for (const Side side : kSides) {
    const std::vector<bool> frames = KnownFrames(
        report.plan.setup, {fmt::format("{} leg", Name(side)), fmt::format("{} foot", Name(side))},
        report.plan.input.recording.markers);
    std::vector<bool>& leg = known[static_cast<std::size_t>(side)];
    for (int k = FramesBeforeFirstSeen(residuals); k < static_cast<int>(frames.size()); ++k) {
      leg.push_back(frames[static_cast<std::size_t>(k)] &&
                    residuals.col(k).array().isFinite().any());
    }
  }
  return known;
}

PoseTrajectory TrackedMotion(const ConversionResult& result) {
  PoseTrajectory motion = result.trajectory;
  const int begin = FramesBeforeFirstSeen(result.residuals);
  motion.first_time = motion.time(begin);
  motion.standard_deviations.resize(0, 0);
  motion.velocities.resize(0, 0);
  motion.accelerations.resize(0, 0);
  motion.postures.erase(motion.postures.begin(), motion.postures.begin() + begin);
  return motion;
}

RecordedForces GroundForces(const Input& input, Warnings* warnings) {
  if (input.forces_file.empty()) return ForcesOf(input.recording, warnings);
  RecordedForces forces = ForcesOf(input.forces_file, input.recording.up_axis, warnings);
  CheckIsOfRecording(forces, input);
  return forces;
}

std::shared_ptr<const StoredEvents> EventsOfFile(const Input& input, const std::string& choice) {
  const Recording& recording = input.recording;
  auto stored = std::make_shared<StoredEvents>();
  if (choice == "file") stored->choice = EventChoice::kFile;
  if (choice == "found") stored->choice = EventChoice::kFound;
  if (recording.format == "C3D") {
    stored->events =
        FootEventsOf(ReadC3dEvents(C3dFile(recording.file), nullptr), recording.subject);
  }
  if (!stored->events.empty()) return stored;
  if (choice != "file") return nullptr;
  throw Error(
      fmt::format("{}: has no events of feet (\"Foot Strike\" and \"Foot Off\" of Left and "
                  "Right); without {} they are found",
                  recording.file, OptionText("events")));
}

void CheckHasForces(const RecordedForces& forces, const Input& input, Warnings* warnings) {
  std::vector<std::string> dead;
  for (const PlateForces& plate : forces.plates) {
    const bool has_forces = plate.force.colwise().sum().array().isFinite().any();
    if (!has_forces) dead.push_back(std::to_string(plate.plate.number));
  }
  if (dead.empty()) return;
  const std::string text = fmt::format(
      "{}: force plate {}: none of its forces is a number; look at its calibration "
      "matrix and its samples",
      ForcesFile(input), JoinNames(dead, " and "));
  if (dead.size() == forces.plates.size()) throw Error(text);
  Warn(warnings, text);
}

const std::string& ForcesFile(const Input& input) {
  return input.forces_file.empty() ? input.recording.file : input.forces_file;
}

void CheckHasPlates(const RecordedForces& forces, const Input& input) {
  if (!forces.plates.empty()) return;
  throw Error(input.recording.file +
              ": has no force plate that can be read, whose forces to export; forces "
              "of another file are named by " +
              OptionText("forces"));
}

std::shared_ptr<const Emg> EmgOf(const Input& input, const std::string& labels,
                                 Warnings* warnings) {
  if (labels.empty()) return nullptr;
  const Recording& recording = input.recording;
  if (recording.format != "C3D") {
    throw Error(fmt::format("{}: has no analog channels, as it is no C3D file; leave out {}",
                            recording.file, OptionText("emg")));
  }
  return std::make_shared<const Emg>(ReadEmg(recording.file, labels, warnings));
}

std::shared_ptr<const GroundStudy> StudyGround(const ConversionReport& report, Warnings* warnings) {
  if (report.ground) return report.ground;
  GroundStudy ground;
  ground.feet = MoveFeet(*report.plan.setup.model, TrackedMotion(report.result));
  const auto& as_read = report.plan.forces;
  auto forces = std::make_shared<RecordedForces>(as_read ? *as_read : RecordedForces());
  ground.doubts = FitPlatesToFeet(ground.feet, FindKnownLegs(report), forces.get(), warnings);
  for (const PlateForces& one : forces->plates) {
    if (one.clipped.empty()) continue;
    ground.doubts.push_back(
        fmt::format("force plate {} is saturated from {:.2f} s on, and tells too little",
                    one.plate.number, forces->time(one.clipped.front().begin)));
  }
  ground.contacts = FindContacts(ground.feet, *forces);
  WarnOfParts(ground.contacts, *forces, warnings);
  ground.steps = report.plan.events
                     ? WithStoredEvents(*report.plan.events, ground.feet, ground.contacts, *forces,
                                        &ground.event_notes)
                     : ground.contacts;
  if (report.plan.events && report.plan.events->choice != EventChoice::kFound) {
    std::string doubt = DoubtOfEvents(*report.plan.events, ground.feet, ground.contacts);
    if (!doubt.empty()) ground.doubts.push_back(std::move(doubt));
  }
  ground.mass = EstimateMass(ground.contacts, *forces, ground.feet);
  if (std::string doubt = DoubtOfScale(ground.mass, report.plan.person.mass); !doubt.empty()) {
    ground.doubts.push_back(std::move(doubt));
  }
  ground.forces = std::move(forces);
  return std::make_shared<const GroundStudy>(std::move(ground));
}

std::string UnappliedSentence(const GroundStudy& ground) {
  const RecordedForces& forces = *ground.forces;
  double all = 0, unapplied = 0;
  std::vector<std::string> texts;
  for (const PlateLoad& load : ground.contacts.loads) {
    const PlateForces& plate = forces.plates[load.plate];
    double impulse = 0;
    for (int k = load.samples.begin; k < load.samples.end; ++k) {
      if (std::isfinite(plate.Load(k))) impulse += plate.Load(k) / forces.rate;
    }
    all += impulse;
    const bool is_one = load.bearer == Bearer::kLeft || load.bearer == Bearer::kRight;
    if (is_one && !load.is_part_of_foot) continue;
    const std::string who = is_one ? fmt::format("a part of the {} foot", Name(load.bearer))
                            : load.bearer == Bearer::kBoth ? "both feet"
                                                           : "no foot is known there";
    unapplied += impulse;
    texts.push_back(fmt::format(
        "plate {} from {:.3f} to {:.3f} s ({}{})", plate.plate.number, load.begin, load.end, who,
        ground.mass ? fmt::format(", {:.0f} % of the body weight on average",
                                  kPercent * impulse / (load.end - load.begin) /
                                      (ground.mass->mass * kStandardGravity))
                    : ""));
  }
  if (texts.empty()) return "";
  constexpr std::size_t kMost = 6;
  const std::size_t more = texts.size() > kMost ? texts.size() - kMost : 0;
  texts.resize(texts.size() - more);
  return fmt::format("{:.0f} % of what the plates bore is applied to no foot: {}{}",
                     kPercent * unapplied / all, fmt::join(texts, ", "),
                     more > 0 ? fmt::format(" and {} more times", more) : "");
}

std::string DeviationSentence(const Contacts& steps) {
  double begins = 0, ends = 0;
  for (const FootContact& one : steps.contacts) {
    if (one.begin) begins = std::max(begins, one.begin_deviation);
    if (one.end) ends = std::max(ends, one.end_deviation);
  }
  if (std::max(begins, ends) <= kToldDeviation) return "";
  const double stance = std::hypot(begins, ends);
  return fmt::format(
      "off force plates feet come to the ground within +-{:.0f} ms and leave it within +-{:.0f} ms "
      "(standard deviations): stance lasts +-{:.0f} ms, double support +-{:.0f} ms",
      kMilliseconds * begins, kMilliseconds * ends, kMilliseconds * stance,
      kMilliseconds * std::numbers::sqrt2 * stance);
}

Contacts SeenContacts(const ConversionReport& report, const GroundStudy& ground) {
  const FootMotion& feet = ground.feet;
  const KnownLegs known = FindKnownLegs(report);
  Contacts seen = ground.steps;
  std::erase_if(seen.contacts, [&](const FootContact& one) { return !IsTold(one, feet, known); });
  for (FootContact& one : seen.contacts) {
    if (!one.plates.empty()) continue;
    const std::vector<bool>& leg = known[static_cast<std::size_t>(one.side)];
    const auto is_seen = [&](double time) {
      return leg[static_cast<std::size_t>(feet.frame(time))];
    };
    if (one.begin && !is_seen(*one.begin - kSeenBeside)) one.begin.reset();
    if (one.end && !is_seen(*one.end + kSeenBeside)) one.end.reset();
  }
  return seen;
}

double KnownMass(const ConversionReport& report, const GroundStudy& ground) {
  const PersonValue& mass = report.plan.person.mass;
  if (IsByPlates(mass)) return mass.value;
  if (IsAssumed(mass) && ground.mass) return ground.mass->mass;
  return report.plan.setup.model->total_mass();
}

std::string MassSentence(const ConversionReport& report, const GroundStudy& ground) {
  if (!ground.mass) return "";
  const PersonValue& mass = report.plan.person.mass;
  std::string borne = fmt::format("the force plates bore {:.1f} +- {:.1f} kg", ground.mass->mass,
                                  ground.mass->deviation);
  if (!(mass.value > 0)) return borne;
  if (IsByPlates(mass)) return borne + ", and nobody says another mass";
  return fmt::format("{}, the person's mass is {:.1f} kg ({}){}", borne, mass.value, mass.source,
                     IsAssumed(mass) && ground.joint_forces
                         ? "; forces and moments are of what the plates bore"
                         : "");
}

JointForces JointForcesOf(const ConversionReport& report, const GroundStudy& ground,
                          bool with_deviations) {
  CheckHasPlates(*ground.forces, report.plan.input);
  const KinematicModel model = WithMass(*report.plan.setup.model, KnownMass(report, ground));
  const PoseTrajectory motion = TrackedMotion(report.result);
  JointForcesOptions options;
  if (HasAnatomy(model)) {
    for (const HeldAxis& one : FindHeldAxes(model)) options.holding.push_back(one.segment);
  }
  JointForces found = ComputeJointForces(model, motion, ground.contacts, *ground.forces, options);
  const int begin = report.result.trajectory.num_frames() - motion.num_frames();
  if (with_deviations && !report.result.covariances.empty()) {
    EstimateDeviations(model, motion, ground.contacts, *ground.forces,
                       CovariancesFrom(begin, report.result), {}, &found);
  }
  return found;
}

Gait GaitOf(const ConversionReport& report, const GroundStudy& ground) {
  AnatomicalAngles angles = ShownAngles(report.plan.setup, report.result.trajectory);
  HideUnknown(report.plan.setup, report.plan.input.recording.markers, &angles);
  Gait gait = AnalyzeGait(ground.feet, ground.steps, angles, FindKnownLegs(report));
  AddForces(report, ground, &gait);
  if (report.plan.emg) AddEmg(*report.plan.emg, &gait);
  return gait;
}

}  // namespace mmm_converter
