// SPDX-License-Identifier: MIT
#include "common/pipeline/force_exports.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "common/angles/anatomical_angles.h"
#include "common/angles/gait_table.h"
#include "common/contacts/contact_table.h"
#include "common/contacts/external_loads_writer.h"
#include "common/contacts/person_mass.h"
#include "common/forces/recording_forces.h"
#include "common/kinetics/joint_forces_table.h"
#include "common/kinetics/moment_deviations.h"
#include "common/pipeline/conversion.h"
#include "common/support/advice.h"
#include "common/support/atomic_file.h"
#include "common/support/error.h"

namespace mmm_converter {
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
  return ForcesOf(input.forces_file, input.recording, warnings);
}

Contacts ContactsOf(const ConversionReport& report, const RecordedForces& forces) {
  return FindContacts(MoveFeet(*report.plan.setup.model, report.result.trajectory), forces);
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
  int begin = 0;
  while (begin < motion.num_frames() && !(result.residuals.col(begin).array() >= 0).any()) ++begin;
  if (begin == motion.num_frames()) return motion;
  motion.first_time = motion.time(begin);
  motion.postures.erase(motion.postures.begin(), motion.postures.begin() + begin);
  return motion;
}

/// Those of a trajectory whose first `begin` frames are left out.
std::vector<PoseCovariance> CovariancesFrom(int begin, const ConversionResult& result) {
  std::vector<PoseCovariance> covariances = result.covariances;
  for (PoseCovariance& one : covariances) one.frame -= begin;
  return covariances;
}

JointForces JointForcesOf(const ConversionReport& report, bool with_deviations) {
  const RecordedForces forces = GroundForces(report.plan.input, nullptr);
  CheckHasPlates(forces, report.plan.input.recording);
  const KinematicModel& model = *report.plan.setup.model;
  const PoseTrajectory motion = TrackedMotion(report.result);
  const Contacts contacts = ContactsOf(report, forces);
  JointForces found = ComputeJointForces(model, motion, contacts, forces);
  const int begin = report.result.trajectory.num_frames() - motion.num_frames();
  if (with_deviations && !report.result.covariances.empty()) {
    EstimateDeviations(model, motion, contacts, forces, CovariancesFrom(begin, report.result), {},
                       &found);
  }
  return found;
}

bool NeedForces(const ExportFiles& files) {
  return files.count(kGrf) > 0 || files.count(kContacts) > 0 || files.count(kJointForces) > 0 ||
         files.count(kGait) > 0;
}

Gait GaitOf(const ConversionReport& report, const RecordedForces& forces) {
  const KinematicModel& model = *report.plan.setup.model;
  const PoseTrajectory& motion = report.result.trajectory;
  const FootMotion feet = MoveFeet(model, motion);
  return AnalyzeGait(feet, FindContacts(feet, forces), ComputeAnatomicalAngles(model, motion));
}

/// Empty: nothing stands beside what is no file.
std::string LoadsFile(const std::string& table) {
  std::error_code failure;
  if (fs::is_other(table, failure)) return "";
  return fs::path(table).replace_extension(".xml").string();
}

}  // namespace

void WriteContacts(const std::string& file, const ConversionReport& report) {
  const RecordedForces forces = GroundForces(report.plan.input, nullptr);
  const Contacts contacts = ContactsOf(report, forces);
  const bool is_json = fs::path(file).extension() == ".json";
  WriteFileAtomically(file,
                      is_json ? FormatContactsJson(contacts, forces) : FormatContactsCsv(contacts));
}

void WriteGait(const std::string& file, const ConversionReport& report) {
  const Gait gait = GaitOf(report, GroundForces(report.plan.input, nullptr));
  const bool is_json = fs::path(file).extension() == ".json";
  WriteFileAtomically(file, is_json ? FormatGaitJson(gait) : FormatGaitCsv(gait));
}

void WriteGrf(const std::string& file, const ConversionReport& report) {
  const RecordedForces forces = GroundForces(report.plan.input, nullptr);
  CheckHasPlates(forces, report.plan.input.recording);
  const Contacts contacts = ContactsOf(report, forces);
  const PoseTrajectory& motion = report.result.trajectory;
  const ExternalLoads loads = {&forces, &contacts, motion.first_time,
                               motion.time(motion.num_frames() - 1)};
  const std::string name = fs::path(file).filename().string();
  WriteFileAtomically(file, FormatExternalLoadsTable(loads, name));
  const std::string beside = LoadsFile(file);
  if (!beside.empty()) WriteFileAtomically(beside, FormatExternalLoadsXml(loads, name));
}

void WriteJointForces(const std::string& file, const ConversionReport& report) {
  const JointForces found = JointForcesOf(report, fs::path(file).extension() != ".sto");
  const std::string ending = fs::path(file).extension().string();
  if (ending == ".json") {
    WriteFileAtomically(file, FormatJointForcesJson(found));
  } else {
    WriteFileAtomically(
        file, ending == ".sto" ? FormatJointForcesSto(found) : FormatJointForcesCsv(found));
  }
}

void CompareForces(const ExportFiles& files, ConversionReport* report) {
  if (files.count(kJointForces) > 0) {
    const JointForces found = JointForcesOf(*report, false);
    const Residuals residuals = MeasureResiduals(found);
    if (!residuals.is_within) report->warnings.Add(SentenceOf(residuals, found));
  }
  if (!NeedForces(files)) return;
  const RecordedForces forces = GroundForces(report->plan.input, nullptr);
  if (files.count(kGait) > 0 && GaitOf(*report, forces).strides.empty()) {
    report->warnings.Add("no foot came to the ground twice within 2.5 s: there is no stride");
  }
  const auto found = EstimateMass(ContactsOf(*report, forces), forces);
  const PersonValue& mass = report->plan.person.mass;
  if (!found || !(mass.value > 0)) return;
  const double apart = std::abs(found->mass - mass.value);
  if (apart <= kMostApart * mass.value || apart <= kDeviations * found->deviation) return;
  report->warnings.Add(
      fmt::format("the force plates bore {:.1f} +- {:.1f} kg; the person's mass is "
                  "{:.1f} kg ({}; another by {})",
                  found->mass, found->deviation, mass.value, mass.source, OptionText("mass")));
}

void CheckForces(const ExportFiles& files, ConversionPlan* plan) {
  if (!NeedForces(files)) return;
  const bool needs_plates = files.count(kGrf) > 0 || files.count(kJointForces) > 0;
  const Recording& recording = plan->input.recording;
  if (!HasFeet(*plan->setup.model)) {
    throw Error(fmt::format(
        "{}: feet on the ground are told of MMM's and OpenSim's models of persons, not of {}",
        recording.file, plan->input.model_file));
  }
  const RecordedForces forces = GroundForces(plan->input, &plan->warnings);
  if (needs_plates) CheckHasPlates(forces, recording);
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
