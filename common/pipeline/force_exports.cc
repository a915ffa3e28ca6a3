// SPDX-License-Identifier: MIT
#include "common/pipeline/force_exports.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "common/contacts/contact_table.h"
#include "common/contacts/external_loads_writer.h"
#include "common/contacts/person_mass.h"
#include "common/forces/recording_forces.h"
#include "common/pipeline/conversion.h"
#include "common/support/advice.h"
#include "common/support/atomic_file.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

constexpr const char* kContacts = "contacts";
constexpr const char* kGrf = "grf";
constexpr double kMostApart = 0.03;  // of the mass
constexpr double kDeviations = 2;

Contacts ContactsOf(const ConversionReport& report, const RecordedForces& forces) {
  return FindContacts(MoveFeet(*report.plan.setup.model, report.result.trajectory), forces);
}

/// Empty: nothing stands beside what is no file.
std::string LoadsFile(const std::string& table) {
  std::error_code failure;
  if (fs::is_other(table, failure)) return "";
  return fs::path(table).replace_extension(".xml").string();
}

void CheckHasPlates(const RecordedForces& forces, const Recording& recording) {
  if (!forces.plates.empty()) return;
  throw Error(recording.file + ": has no force plate that can be read, whose forces to export");
}

}  // namespace

void WriteContacts(const std::string& file, const ConversionReport& report) {
  const RecordedForces forces = ForcesOf(report.plan.input.recording, nullptr);
  const Contacts contacts = ContactsOf(report, forces);
  const bool is_json = fs::path(file).extension() == ".json";
  WriteFileAtomically(file,
                      is_json ? FormatContactsJson(contacts, forces) : FormatContactsCsv(contacts));
}

void WriteGrf(const std::string& file, const ConversionReport& report) {
  const RecordedForces forces = ForcesOf(report.plan.input.recording, nullptr);
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

void CompareMass(const ExportFiles& files, ConversionReport* report) {
  if (files.count(kGrf) == 0 && files.count(kContacts) == 0) return;
  const RecordedForces forces = ForcesOf(report->plan.input.recording, nullptr);
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
  const bool needs_plates = files.count(kGrf) > 0;
  if (!needs_plates && files.count(kContacts) == 0) return;
  const Recording& recording = plan->input.recording;
  if (!HasFeet(*plan->setup.model)) {
    throw Error(fmt::format(
        "{}: feet on the ground are told of MMM's and OpenSim's models of persons, not of {}",
        recording.file, plan->input.model_file));
  }
  const RecordedForces forces = ForcesOf(recording, &plan->warnings);
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
