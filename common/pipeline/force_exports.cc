// SPDX-License-Identifier: MIT
#include "common/pipeline/force_exports.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "common/angles/anatomical_angles.h"
#include "common/angles/gait_table.h"
#include "common/contacts/contact_table.h"
#include "common/contacts/external_loads_writer.h"
#include "common/contacts/person_mass.h"
#include "common/forces/recording_forces.h"
#include "common/judge/coverage.h"
#include "common/kinetics/joint_forces_table.h"
#include "common/kinetics/moment_deviations.h"
#include "common/motion/marker_residuals.h"
#include "common/pipeline/conversion.h"
#include "common/support/advice.h"
#include "common/support/atomic_file.h"
#include "common/support/error.h"

namespace mmm_converter {

/// What exports are made of: found once for a conversion.
struct GroundStudy {
  std::shared_ptr<const RecordedForces> forces;
  FootMotion feet;
  Contacts contacts;
  std::optional<JointForces> joint_forces;  ///< where they are exported
  std::optional<Gait> gait;                 ///< where it is exported
};

namespace {

namespace fs = std::filesystem;

constexpr const char* kContacts = "contacts";
constexpr const char* kGrf = "grf";
constexpr const char* kGait = "gait";
constexpr const char* kJointForces = "inverse-dynamics";
constexpr double kMostApart = 0.03;  // of the mass
constexpr double kDeviations = 2;

/// Of the recording's file, or of the one that is beside it.
RecordedForces GroundForces(const Input& input, Warnings* warnings) {
  if (input.forces_file.empty()) return ForcesOf(input.recording, warnings);
  return ForcesOf(input.forces_file, input.recording.up_axis, warnings);
}

void CheckHasPlates(const RecordedForces& forces, const Recording& recording) {
  if (!forces.plates.empty()) return;
  throw Error(recording.file +
              ": has no force plate that can be read, whose forces to export; forces "
              "of another file are named by " +
              OptionText("forces"));
}

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

/// Of the mass that plates bore, where none was given.
KinematicModel WithKnownMass(const ConversionReport& report, const GroundStudy& ground) {
  const KinematicModel& model = *report.plan.setup.model;
  const auto measured = EstimateMass(ground.contacts, *ground.forces);
  if (!measured || !IsAssumed(report.plan.person.mass)) return model;
  ModelDescription description = DescriptionOf(model);
  const double scale = measured->mass / model.total_mass();
  for (Segment& segment : description.segments) {
    segment.mass *= scale;
    segment.inertia *= scale;
  }
  return KinematicModel(std::move(description));
}

JointForces JointForcesOf(const ConversionReport& report, const GroundStudy& ground,
                          bool with_deviations) {
  CheckHasPlates(*ground.forces, report.plan.input.recording);
  const KinematicModel model = WithKnownMass(report, ground);
  const PoseTrajectory motion = TrackedMotion(report.result);
  JointForces found = ComputeJointForces(model, motion, ground.contacts, *ground.forces);
  const int begin = report.result.trajectory.num_frames() - motion.num_frames();
  if (with_deviations && !report.result.covariances.empty()) {
    EstimateDeviations(model, motion, ground.contacts, *ground.forces,
                       CovariancesFrom(begin, report.result), {}, &found);
  }
  return found;
}

bool HasDeviations(const std::string& file) { return fs::path(file).extension() != ".sto"; }

/// Where a leg shows what the verdict asks of it; without limbs, where the body is seen.
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
    for (int k = 0; k < markers.num_frames(); ++k) {
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

Gait GaitOf(const ConversionReport& report, const GroundStudy& ground) {
  const AnatomicalAngles angles =
      ComputeAnatomicalAngles(*report.plan.setup.model, report.result.trajectory);
  return AnalyzeGait(ground.feet, ground.contacts, angles, FindKnownLegs(report));
}

GroundStudy StudyGround(const ConversionReport& report) {
  GroundStudy ground;
  ground.forces = report.plan.forces;
  if (!ground.forces) {
    ground.forces =
        std::make_shared<const RecordedForces>(GroundForces(report.plan.input, nullptr));
  }
  ground.feet = MoveFeet(*report.plan.setup.model, report.result.trajectory);
  ground.contacts = FindContacts(ground.feet, *ground.forces);
  return ground;
}

std::shared_ptr<const GroundStudy> GroundOf(const ConversionReport& report) {
  if (report.ground) return report.ground;
  return std::make_shared<const GroundStudy>(StudyGround(report));
}

bool NeedForces(const ExportFiles& files) {
  return files.count(kGrf) > 0 || files.count(kContacts) > 0 || files.count(kJointForces) > 0 ||
         files.count(kGait) > 0;
}

/// Empty: nothing stands beside what is no file.
std::string LoadsFile(const std::string& table) {
  std::error_code failure;
  if (fs::is_other(table, failure)) return "";
  return fs::path(table).replace_extension(".xml").string();
}

/// Warns where the plates tell another mass than the person's.
void CompareMass(const GroundStudy& ground, ConversionReport* report) {
  const auto found = EstimateMass(ground.contacts, *ground.forces);
  const PersonValue& mass = report->plan.person.mass;
  if (!found || !(mass.value > 0)) return;
  const double apart = std::abs(found->mass - mass.value);
  if (apart <= kMostApart * mass.value || apart <= kDeviations * found->deviation) return;
  if (report->ground->joint_forces && IsAssumed(mass)) {
    report->warnings.Add(
        fmt::format("moments are of the {:.1f} +- {:.1f} kg that the force plates bore ({})",
                    found->mass, found->deviation, OptionText("mass")));
    return;
  }
  report->warnings.Add(
      fmt::format("the force plates bore {:.1f} +- {:.1f} kg; the person's mass is "
                  "{:.1f} kg ({}; another by {})",
                  found->mass, found->deviation, mass.value, mass.source, OptionText("mass")));
}

}  // namespace

void WriteContacts(const std::string& file, const ConversionReport& report) {
  const auto ground = GroundOf(report);
  const bool is_json = fs::path(file).extension() == ".json";
  WriteFileAtomically(file, is_json ? FormatContactsJson(ground->contacts, *ground->forces)
                                    : FormatContactsCsv(ground->contacts));
}

void WriteGait(const std::string& file, const ConversionReport& report) {
  const auto ground = GroundOf(report);
  const Gait gait = ground->gait ? *ground->gait : GaitOf(report, *ground);
  const bool is_json = fs::path(file).extension() == ".json";
  WriteFileAtomically(file, is_json ? FormatGaitJson(gait) : FormatGaitCsv(gait));
}

void WriteGrf(const std::string& file, const ConversionReport& report) {
  const auto ground = GroundOf(report);
  CheckHasPlates(*ground->forces, report.plan.input.recording);
  const PoseTrajectory& motion = report.result.trajectory;
  const ExternalLoads loads = {ground->forces.get(), &ground->contacts, motion.first_time,
                               motion.time(motion.num_frames() - 1)};
  const std::string name = fs::path(file).filename().string();
  WriteFileAtomically(file, FormatExternalLoadsTable(loads, name));
  const std::string beside = LoadsFile(file);
  if (!beside.empty()) WriteFileAtomically(beside, FormatExternalLoadsXml(loads, name));
}

void WriteJointForces(const std::string& file, const ConversionReport& report) {
  const auto ground = GroundOf(report);
  const JointForces found = ground->joint_forces
                                ? *ground->joint_forces
                                : JointForcesOf(report, *ground, HasDeviations(file));
  const std::string ending = fs::path(file).extension().string();
  if (ending == ".json") {
    WriteFileAtomically(file, FormatJointForcesJson(found));
  } else {
    WriteFileAtomically(
        file, ending == ".sto" ? FormatJointForcesSto(found) : FormatJointForcesCsv(found));
  }
}

void CompareForces(const ExportFiles& files, ConversionReport* report) {
  if (!NeedForces(files)) return;
  auto ground = std::make_shared<GroundStudy>(StudyGround(*report));
  report->ground = ground;
  const auto joint_forces = files.find(kJointForces);
  if (joint_forces != files.end()) {
    ground->joint_forces = JointForcesOf(*report, *ground, HasDeviations(joint_forces->second));
    const Residuals residuals = MeasureResiduals(*ground->joint_forces);
    if (!residuals.is_within) {
      report->warnings.Add(SentenceOf(residuals, *ground->joint_forces));
    }
  }
  if (files.count(kGait) > 0) {
    ground->gait = GaitOf(*report, *ground);
    if (ground->gait->left_out > 0) {
      report->warnings.Add(fmt::format("{} of {} strides are left out: a leg is hidden in them",
                                       ground->gait->left_out,
                                       ground->gait->left_out + ground->gait->strides.size()));
    } else if (ground->gait->strides.empty()) {
      report->warnings.Add("no foot came to the ground twice within 2.5 s: there is no stride");
    }
  }
  CompareMass(*ground, report);
}

void CheckForces(const ExportFiles& files, ConversionPlan* plan) {
  if (!NeedForces(files)) return;
  const bool needs_plates = files.count(kGrf) > 0 || files.count(kJointForces) > 0;
  const Recording& recording = plan->input.recording;
  if (!HasFeet(*plan->setup.model)) {
    throw Error(fmt::format(
        "{}: contacts, strides and joint forces need the feet of MMM's model, or segments calcn_l, "
        "calcn_r, toes_l and toes_r as OpenSim's persons have; {} lacks them",
        recording.file, plan->input.model_file));
  }
  if (files.count(kJointForces) > 0 && !(plan->setup.model->total_mass() > 0)) {
    throw Error(plan->input.model_file + ": has no masses, hence no dynamics");
  }
  plan->forces = std::make_shared<const RecordedForces>(GroundForces(plan->input, &plan->warnings));
  if (needs_plates) CheckHasPlates(*plan->forces, recording);
}

std::vector<std::string> FilesOf(const ExportFiles& files) {
  std::vector<std::string> all;
  for (const auto& [name, file] : files) {
    all.push_back(file);
    if (name == kGrf) all.push_back(LoadsFile(file));
  }
  return all;
}

}  // namespace mmm_converter
