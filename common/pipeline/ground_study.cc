// SPDX-License-Identifier: MIT
#include "common/pipeline/ground_study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/angles/anatomical_angles.h"
#include "common/contacts/person_mass.h"
#include "common/contacts/plate_readings.h"
#include "common/contacts/stored_events.h"
#include "common/forces/recording_forces.h"
#include "common/judge/coverage.h"
#include "common/kinetics/foot_wrenches.h"
#include "common/kinetics/moment_deviations.h"
#include "common/motion/marker_residuals.h"
#include "common/pipeline/conversion.h"
#include "common/support/advice.h"
#include "common/support/error.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

/// Without the frames before the person was seen.
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

constexpr const char* kPower = "power";

/// Between the frames beside each [1/s].
Eigen::RowVectorXd RateOf(const Eigen::RowVectorXd& values, double rate) {
  const Eigen::Index last = values.size() - 1;
  Eigen::RowVectorXd rates = Eigen::RowVectorXd::Zero(values.size());
  for (Eigen::Index k = 0; k <= last && last > 0; ++k) {
    const Eigen::Index before = std::max<Eigen::Index>(0, k - 1), after = std::min(k + 1, last);
    rates[k] = rate * (values[after] - values[before]) / static_cast<double>(after - before);
  }
  return rates;
}

/// The moment against the one that makes an angle grow.
const char* OppositeOf(std::string_view motion) {
  if (motion == "flexion") return "extension moment";
  if (motion == "dorsiflexion") return "plantar flexion moment";
  if (motion == "adduction") return "abduction moment";
  if (motion == "inversion") return "eversion moment";
  return motion == "internal rotation" ? "external rotation moment" : nullptr;
}

bool IsOfLeg(std::string_view joint) {
  return joint == "hip" || joint == "knee" || joint == "ankle";
}

/// By the model's joints, as far as they are known.
Eigen::MatrixXd ByJoints(const KinematicModel& model, const JointForces& found) {
  Eigen::MatrixXd forces = Eigen::MatrixXd::Constant(model.num_joints(), found.num_frames(), kNaN);
  for (std::size_t i = 0; i < found.names.size(); ++i) {
    const int joint = model.FindJoint(found.names[i]);
    if (joint >= 0) forces.row(joint) = found.forces.row(static_cast<Eigen::Index>(i));
  }
  return forces;
}

/// In body weights; NaN: no plate measures it.
AnatomicalAngles VerticalForces(const ConversionReport& report, const GroundStudy& ground) {
  const PoseTrajectory& motion = report.result.trajectory;
  const FootWrenches feet = WrenchesOnFeet(
      ground.contacts, *ground.forces, {motion.rate, motion.first_time, motion.num_frames()}, 0);
  AnatomicalAngles rows;
  rows.rate = motion.rate;
  rows.first_time = motion.first_time;
  rows.values.resize(2, motion.num_frames());
  const double weight = KnownMass(report, ground) * kStandardGravity;
  for (const Side side : kSides) {
    rows.angles.push_back({"ground", Name(side), "vertical force"});
    const FootWrench& foot = feet[static_cast<std::size_t>(side)];
    for (int k = 0; k < motion.num_frames(); ++k) {
      rows.values(static_cast<Eigen::Index>(side), k) =
          foot.is_known[static_cast<std::size_t>(k)] ? foot.force(2, k) / weight : kNaN;
    }
  }
  return rows;
}

/// What the root would still need, for the strides of each foot.
AnatomicalAngles ResidualRows(const JointForces& found) {
  AnatomicalAngles rows;
  rows.rate = found.rate;
  rows.first_time = found.first_time;
  rows.values.resize(4, found.num_frames());
  for (const Side side : kSides) {
    rows.angles.push_back({"residual", Name(side), "force"});
    rows.angles.push_back({"residual", Name(side), "moment"});
  }
  for (Eigen::Index i = 0; i < rows.values.rows(); i += 2) {
    rows.values.row(i) =
        found.residuals.topRows<3>().colwise().norm() / (found.mass * kStandardGravity);
    rows.values.row(i + 1) = found.residuals.bottomRows<3>().colwise().norm() / found.mass;
  }
  return rows;
}

/// Moments and powers of muscles, by mass.
AnatomicalAngles LegMoments(const ConversionReport& report, const JointForces& found) {
  const KinematicModel& model = *report.plan.setup.model;
  const PoseTrajectory motion = TrackedMotion(report.result);
  const AnatomicalAngles angles =
      ComputeAnatomicalAngles(model, SmoothMotion(model, motion, found.cutoff));
  const Eigen::MatrixXd moments =
      AnatomicalMoments(model, motion, ByJoints(model, found)) / found.mass;
  AnatomicalAngles rows;
  rows.rate = motion.rate;
  rows.first_time = motion.first_time;
  rows.values.resize(2 * moments.rows(), moments.cols());
  const auto add = [&](const AnatomicalAngle& angle, const Eigen::RowVectorXd& values) {
    rows.values.row(static_cast<Eigen::Index>(rows.angles.size())) = values;
    rows.angles.push_back(angle);
  };
  for (std::size_t begin = 0, end = 0; begin < angles.angles.size(); begin = end) {
    const AnatomicalAngle& first = angles.angles[begin];
    Eigen::RowVectorXd power = Eigen::RowVectorXd::Zero(moments.cols());
    for (; end < angles.angles.size(); ++end) {
      const AnatomicalAngle& angle = angles.angles[end];
      if (std::string_view(angle.joint) != first.joint ||
          std::string_view(angle.side) != first.side) {
        break;
      }
      const auto row = static_cast<Eigen::Index>(end);
      power += moments.row(row).cwiseProduct(RateOf(angles.values.row(row), motion.rate));
      const char* name = OppositeOf(angle.motion);
      if (IsOfLeg(angle.joint) && name != nullptr) {
        add({angle.joint, angle.side, name}, -moments.row(row));
      }
    }
    if (IsOfLeg(first.joint)) add({first.joint, first.side, kPower}, power);
  }
  rows.values.conservativeResize(static_cast<Eigen::Index>(rows.angles.size()), Eigen::NoChange);
  return rows;
}

/// What each leg's joints give and take in each stride in which their power is known, means.
std::vector<JointWork> WorkOf(const AnatomicalAngles& rows, const std::vector<Stride>& strides) {
  std::vector<JointWork> works;
  for (std::size_t i = 0; i < rows.angles.size(); ++i) {
    const AnatomicalAngle& angle = rows.angles[i];
    if (std::string_view(angle.motion) != kPower) continue;
    JointWork work = {angle.joint, angle.side};
    for (const Stride& stride : strides) {
      if (std::string_view(Name(stride.side)) != angle.side) continue;
      const auto frame = [&](double time) {
        return static_cast<Eigen::Index>(std::lround((time - rows.first_time) * rows.rate));
      };
      const Eigen::Index begin = std::max<Eigen::Index>(0, frame(stride.begin));
      const Eigen::Index end = std::min(frame(stride.end), rows.values.cols());
      if (end <= begin) continue;
      const auto power = rows.values.row(static_cast<Eigen::Index>(i)).segment(begin, end - begin);
      if (!power.allFinite()) continue;
      work.generated += power.cwiseMax(0).sum() / rows.rate;
      work.absorbed -= power.cwiseMin(0).sum() / rows.rate;
      ++work.strides;
    }
    if (work.strides == 0) continue;
    work.generated /= work.strides;
    work.absorbed /= work.strides;
    works.push_back(work);
  }
  return works;
}

/// Where a leg shows what the verdict asks of it; without limbs, where the body is seen. By frame
/// of TrackedMotion.
KnownLegs FindKnownLegs(const ConversionReport& report) {
  const MarkerSequence& markers = report.plan.input.recording.markers;
  const Eigen::MatrixXd& residuals = report.result.residuals;
  const std::vector<Limb> limbs = LimbsOf(report.plan.setup);
  KnownLegs known;
  for (const Side side : kSides) {
    const std::string name = fmt::format("{} leg", Name(side));
    const auto limb =
        std::find_if(limbs.begin(), limbs.end(), [&](const Limb& one) { return one.name == name; });
    std::vector<bool>& leg = known[static_cast<std::size_t>(side)];
    for (int k = FramesBeforeFirstSeen(residuals); k < markers.num_frames(); ++k) {
      bool is_known = residuals.col(k).array().isFinite().any();
      if (is_known && limb != limbs.end()) {
        const auto seen = std::count_if(limb->labels.begin(), limb->labels.end(), [&](int label) {
          return IsSeen(markers.frame(k).col(label));
        });
        is_known = limb->IsKnownBy(static_cast<int>(seen));
      }
      leg.push_back(is_known);
    }
  }
  return known;
}

/// Those of the gait's strides, where there are plates and the model has a mass.
void AddForces(const ConversionReport& report, const GroundStudy& ground, Gait* gait) {
  if (ground.forces->plates.empty() || gait->strides.empty() ||
      !(report.plan.setup.model->total_mass() > 0)) {
    return;
  }
  const JointForces found =
      ground.joint_forces ? *ground.joint_forces : JointForcesOf(report, ground, false);
  const AnatomicalAngles legs = LegMoments(report, found);
  for (const AnatomicalAngles& rows : {VerticalForces(report, ground), legs, ResidualRows(found)}) {
    const std::vector<GaitCycle> more = CyclesOf(rows, gait->strides);
    gait->forces.insert(gait->forces.end(), more.begin(), more.end());
  }
  gait->work = WorkOf(legs, gait->strides);
}

/// Whether it is told by plates, or by a leg that is seen for most of it.
bool IsTold(const FootContact& contact, const FootMotion& feet, const KnownLegs& known) {
  const std::vector<bool>& leg = known[static_cast<std::size_t>(contact.side)];
  const int last = feet.num_frames() - 1;
  const int from = contact.begin ? feet.frame(*contact.begin) : 0;
  const int to = contact.end ? feet.frame(*contact.end) : last;
  if (!contact.plates.empty() || to < from) return !contact.plates.empty();
  return 2 * std::count(leg.begin() + from, leg.begin() + to + 1, true) > to - from;
}

constexpr double kMostTimes = 1.5;                // of a stated mass: what people carry is less
constexpr double kLightest = 8, kHeaviest = 250;  // [kg] persons who walk

/// Empty: the plates bore what a person weighs.
std::string DoubtOfScale(const std::optional<MassByPlates>& borne, const PersonValue& stated) {
  if (!borne) return "";
  const bool is_stated = stated.value > 0 && !IsAssumed(stated);
  const bool is_far =
      is_stated ? std::max(borne->mass / stated.value, stated.value / borne->mass) > kMostTimes
                : borne->mass < kLightest || borne->mass > kHeaviest;
  if (!is_far) return "";
  return fmt::format(
      "the force plates bore {:.3g} kg{}: their forces are of another scale", borne->mass,
      is_stated ? fmt::format(", the person's mass is {:.3g} kg ({})", stated.value, stated.source)
                : "");
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
  ground.steps = report.plan.events
                     ? WithStoredEvents(*report.plan.events, ground.feet, ground.contacts, *forces,
                                        &ground.event_notes)
                     : ground.contacts;
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
    if (load.bearer == Bearer::kLeft || load.bearer == Bearer::kRight) continue;
    unapplied += impulse;
    texts.push_back(
        fmt::format("plate {} from {:.3f} to {:.3f} s ({}{})", plate.plate.number, load.begin,
                    load.end, load.bearer == Bearer::kBoth ? "both feet" : "no foot is known there",
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
    if (one.begin && !is_seen(*one.begin)) one.begin.reset();
    if (one.end && !is_seen(*one.end)) one.end.reset();
  }
  return seen;
}

double KnownMass(const ConversionReport& report, const GroundStudy& ground) {
  const double modelled = report.plan.setup.model->total_mass();
  if (!IsAssumed(report.plan.person.mass)) return modelled;
  return ground.mass ? ground.mass->mass : modelled;
}

std::string MassSentence(const ConversionReport& report, const GroundStudy& ground) {
  if (!ground.mass) return "";
  const PersonValue& mass = report.plan.person.mass;
  const std::string borne = fmt::format("the force plates bore {:.1f} +- {:.1f} kg",
                                        ground.mass->mass, ground.mass->deviation);
  if (!(mass.value > 0)) return borne;
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
  JointForces found = ComputeJointForces(model, motion, ground.contacts, *ground.forces);
  const int begin = report.result.trajectory.num_frames() - motion.num_frames();
  if (with_deviations && !report.result.covariances.empty()) {
    EstimateDeviations(model, motion, ground.contacts, *ground.forces,
                       CovariancesFrom(begin, report.result), {}, &found);
  }
  return found;
}

Gait GaitOf(const ConversionReport& report, const GroundStudy& ground) {
  const AnatomicalAngles angles =
      ComputeAnatomicalAngles(*report.plan.setup.model, report.result.trajectory);
  Gait gait = AnalyzeGait(ground.feet, ground.steps, angles, FindKnownLegs(report));
  AddForces(report, ground, &gait);
  return gait;
}

}  // namespace mmm_converter
