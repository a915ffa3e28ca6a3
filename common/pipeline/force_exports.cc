// SPDX-License-Identifier: MIT
#include "common/pipeline/force_exports.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/angles/gait_table.h"
#include "common/angles/normal_bands.h"
#include "common/contacts/contact_table.h"
#include "common/contacts/external_loads_writer.h"
#include "common/contacts/stored_events.h"
#include "common/io/c3d/c3d_file.h"
#include "common/io/c3d/c3d_relabelling.h"
#include "common/kinetics/joint_forces_table.h"
#include "common/math/statistics.h"
#include "common/motion/anatomical_angles.h"
#include "common/pipeline/all_motions.h"
#include "common/pipeline/conversion.h"
#include "common/pipeline/gait_forces.h"
#include "common/pipeline/ground_study.h"
#include "common/study/coverage.h"
#include "common/support/advice.h"
#include "common/support/atomic_file.h"
#include "common/support/error.h"
#include "common/support/error_of_file.h"
#include "common/support/output_plan.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

/// Which of a point's three values: in the sagittal, frontal or transverse plane.
struct Plane {
  const char* motion;
  Eigen::Index index;
};
constexpr Plane kPlanes[] = {{"tilt", 0},
                             {"flexion", 0},
                             {"dorsiflexion", 0},
                             {"obliquity", 1},
                             {"lateral bending", 1},
                             {"adduction", 1},
                             {"inversion", 1},
                             {"radial deviation", 1},
                             {"rotation", 2},
                             {"internal rotation", 2},
                             {"pronation", 2},
                             {"extension moment", 0},
                             {"plantar flexion moment", 0},
                             {"abduction moment", 1},
                             {"eversion moment", 1},
                             {"external rotation moment", 2},
                             {"power", 2}};

std::optional<Eigen::Index> PlaneOf(std::string_view motion) {
  for (const Plane& one : kPlanes) {
    if (motion == one.motion) return one.index;
  }
  return {};
}

C3dResultKind KindOf(std::string_view motion) {
  if (motion == "power") return C3dResultKind::kPower;
  return motion.ends_with("moment") ? C3dResultKind::kMoment : C3dResultKind::kAngle;
}

/// "LKneeAngles": the joint as gait laboratories write it.
std::string LabelOf(std::string_view joint, Side side, C3dResultKind kind) {
  std::string name(joint == "trunk" ? "spine" : joint);
  name[0] = static_cast<char>(name[0] - 'a' + 'A');
  const char* what = kind == C3dResultKind::kAngle    ? "Angles"
                     : kind == C3dResultKind::kMoment ? "Moment"
                                                      : "Power";
  return fmt::format("{}{}{}", side == Side::kLeft ? 'L' : 'R', name, what);
}

/// The quarters of a turn nearest to most of these [rad]: by Plug-in Gait the pelvis turns against
/// the axis of the laboratory along which the person walks.
double NearestQuarter(const Eigen::RowVectorXd& turns) {
  std::vector<double> known;
  std::copy_if(turns.begin(), turns.end(), std::back_inserter(known),
               [](double one) { return std::isfinite(one); });
  constexpr double kQuarter = std::numbers::pi / 2;
  return known.empty() ? 0 : kQuarter * std::round(Median(known) / kQuarter);
}

class ResultPoints {
 public:
  ResultPoints(std::string prefix, int first_frame, const KnownLegs& known)
      : prefix_(std::move(prefix)), first_frame_(first_frame), known_(known) {}

  /// Rows of angles [rad], moments and powers, for each side that has them.
  void Add(const AnatomicalAngles& rows) {
    for (std::size_t i = 0; i < rows.angles.size(); ++i) {
      const AnatomicalAngle& row = rows.angles[i];
      const std::optional<Eigen::Index> plane = PlaneOf(row.motion);
      if (!plane) continue;
      Eigen::RowVectorXd values = rows.values.row(static_cast<Eigen::Index>(i));
      if (std::string_view(row.joint) == "pelvis" && *plane == 2) {
        values.array() -= NearestQuarter(values);
      }
      for (const Side side : kSides) {
        if (*row.side != '\0' && std::string_view(row.side) != Name(side)) continue;
        const C3dResultKind kind = KindOf(row.motion);
        const double unit = kind == C3dResultKind::kAngle ? kDegrees : 1;
        C3dResult& result = ResultOf(row.joint, side, kind, rows.num_frames());
        result.values.row(*plane) += unit * OwnSideSign(row.joint, row.motion, side) * values;
        if (kind != C3dResultKind::kAngle && IsOfLeg(row.joint)) Hide(side, &result);
      }
    }
  }

  std::vector<C3dResult> Take() { return std::move(results_); }

 private:
  C3dResult& ResultOf(std::string_view joint, Side side, C3dResultKind kind, int frames) {
    const std::string label = prefix_ + LabelOf(joint, side, kind);
    const auto [found, is_new] = places_.try_emplace(label, results_.size());
    if (is_new) {
      results_.push_back({label, kind, first_frame_, Eigen::Matrix3Xd::Zero(3, frames)});
    }
    return results_[found->second];
  }

  void Hide(Side side, C3dResult* result) const {
    const std::vector<bool>& leg = known_[static_cast<std::size_t>(side)];
    for (Eigen::Index k = 0; k < result->values.cols(); ++k) {
      if (!leg[static_cast<std::size_t>(k)]) result->values.col(k).setConstant(kNaN);
    }
  }

  std::string prefix_;
  int first_frame_;
  const KnownLegs& known_;
  std::map<std::string, std::size_t> places_;
  std::vector<C3dResult> results_;
};

/// "Anna:" where the file's labels begin so; else empty.
std::string PrefixOf(const C3dFile& file, const std::string& subject) {
  const std::vector<std::string> names = C3dPointNames(file, nullptr);
  const std::string prefix = subject + ":";
  const bool has_prefix =
      !subject.empty() && std::any_of(names.begin(), names.end(),
                                      [&](const auto& one) { return one.starts_with(prefix); });
  return has_prefix ? prefix : "";
}

int FirstFrame(const C3dFile& file, const PoseTrajectory& motion) {
  // Rates of files are floats.
  constexpr double kSameRate = 1e-3;
  const double rate = file.layout().rate > 0 ? file.layout().rate : motion.rate;
  if (std::abs(rate - motion.rate) > kSameRate * rate) {
    throw Error(fmt::format(
        "{}: has {:g} frames a second, and the motion {:g}: its angles are no points of "
        "that file",
        file.path(), rate, motion.rate));
  }
  return static_cast<int>(std::lround((motion.first_time - file.layout().first_time(rate)) * rate));
}

/// Angles, and where there are plates moments and powers, as points of the recording's C3D file:
/// LHipAngles (flexion, adduction, internal rotation), LHipMoment, LHipPower (third value), with
/// the subject's prefix where the file's labels have it. Turns of pelvis, spine and neck stand
/// there as each side sees them. What a hidden leg would tell is not known, and neither is what the
/// file can't hold, which is warned of.
/// @throws Error where the file's frames have another rate than the motion.
std::vector<C3dResult> C3dResultsOf(const ConversionReport& report, const GroundStudy& ground,
                                    Warnings* warnings) {
  const Recording& recording = report.plan.input.recording;
  const C3dFile file(recording.file);
  const PoseTrajectory motion = TrackedMotion(report.result);
  const KnownLegs known = FindKnownLegs(report);
  ResultPoints points(PrefixOf(file, recording.subject), FirstFrame(file, motion), known);
  AnatomicalAngles angles = ShownAngles(report.plan.setup, motion);
  HideUnknown(report.plan.setup, recording.markers, &angles);
  points.Add(angles);
  if (const auto moments = LegMomentsOf(report, ground)) points.Add(*moments);
  std::vector<C3dResult> results = points.Take();
  const std::vector<std::string> hidden = HideUnstorable(file, &results);
  if (!hidden.empty()) {
    Warn(warnings,
         fmt::format("{} stores 16 bit integers, which can't hold all values of {}: these "
                     "are not written into its copy",
                     recording.file, fmt::join(hidden, ", ")));
  }
  return results;
}

namespace fs = std::filesystem;

constexpr const char* kContacts = "contacts";
constexpr const char* kGrf = "grf";
constexpr const char* kGait = "gait";
constexpr const char* kResults = "c3d";
constexpr const char* kJointForces = "inverse-dynamics";
constexpr double kMostApart = 0.03;   // of the mass
constexpr double kMostCarried = 0.9;  // of the mass, by feet whose person holds on to something
constexpr double kDeviations = 2;

bool HasDeviations(const std::string& file) { return fs::path(file).extension() != ".sto"; }

bool NeedForces(const ExportFiles& files) {
  return files.count(kGrf) > 0 || files.count(kContacts) > 0 || files.count(kJointForces) > 0 ||
         files.count(kGait) > 0 || files.count(kResults) > 0;
}

/// Empty: nothing stands beside what is no file.
std::string LoadsFile(const std::string& table) {
  std::error_code failure;
  if (fs::is_other(table, failure)) return "";
  return fs::path(table).replace_extension(".xml").string();
}

/// Warns where the plates tell another mass than the person's.
void CompareMass(const GroundStudy& ground, ConversionReport* report) {
  const auto& found = ground.mass;
  const PersonValue& mass = report->plan.person.mass;
  if (!found || !(mass.value > 0)) return;
  const double apart = std::abs(found->mass - mass.value);
  if (apart <= kMostApart * mass.value || apart <= kDeviations * found->deviation) return;
  const bool is_carried = !IsAssumed(mass) && found->mass < kMostCarried * mass.value;
  report->warnings.Add(fmt::format("{}{} (another by {})", MassSentence(*report, ground),
                                   is_carried ? "; do hands on a walking aid carry the rest?" : "",
                                   OptionText("mass")));
}

bool IsC3d(const std::string& file) {
  return ToLower(fs::path(file).extension().string()) == ".c3d";
}

/// What there is to say of strides; empty: nothing.
std::string GaitSentence(const Gait& gait) {
  std::vector<std::string> texts;
  if (gait.left_out > 0) {
    texts.push_back(fmt::format(
        "{} left out, in which a leg or a foot is hidden",
        gait.left_out == 1 ? "1 stride is" : fmt::format("{} strides are", gait.left_out)));
  }
  if (gait.turns > 0) {
    texts.push_back(fmt::format("{} left out of the means",
                                gait.turns == 1
                                    ? "1 stride over a turn is"
                                    : fmt::format("{} strides over a turn are", gait.turns)));
  }
  if (gait.strides.empty() && texts.empty()) {
    texts.push_back(fmt::format(
        "no foot came to the ground twice within {:g} s: there is no stride", kLongestStride));
  }
  if (gait.kind != GaitKind::kWalking && !gait.strides.empty()) {
    texts.push_back(fmt::format("most strides are of {}", Name(gait.kind)));
  }
  return fmt::format("{}", fmt::join(texts, "; "));
}

/// The recording's events, and what contacts tell beyond; where found ones count, or the file's are
/// doubtful, they replace the person's among the recording's.
std::vector<C3dEvent> AllEvents(const Contacts& contacts, const ConversionReport& report) {
  const PoseTrajectory& motion = report.result.trajectory;
  const std::string& person = report.plan.input.recording.subject;
  const auto& stored = report.plan.events;
  const GroundStudy& ground = *report.ground;
  const bool replaces = stored && (stored->choice == EventChoice::kFound ||
                                   !DoubtOfEvents(*stored, ground.feet, ground.contacts).empty());
  std::vector<C3dEvent> events = ReadC3dEvents(C3dFile(report.plan.input.recording.file), nullptr);
  std::erase_if(events, [&](const C3dEvent& one) {
    const bool is_of_person = one.subject.empty() || person.empty() || one.subject == person;
    return one.is_in_header ||
           (replaces && FootEventOf(one) && is_of_person && one.time >= motion.first_time &&
            one.time <= motion.time(motion.num_frames() - 1));
  });
  for (const ContactEvent& one : EventsOf(contacts)) {
    if (!replaces && IsAmong(FootEventsOf(events, person), one)) continue;
    events.push_back({one.time, one.label, ContextOf(one.side), person, false});
  }
  std::stable_sort(events.begin(), events.end(),
                   [](const C3dEvent& a, const C3dEvent& b) { return a.time < b.time; });
  return events;
}

}  // namespace

void WriteContacts(const std::string& file, const ConversionReport& report) {
  const auto& ground = report.ground;
  if (IsC3d(file)) {
    WriteC3dWithEvents(report.plan.input.recording.file, ground->events, file);
    return;
  }
  const Contacts contacts = SeenContacts(report, *ground);
  const bool is_json = fs::path(file).extension() == ".json";
  WriteFileAtomically(file, is_json ? FormatContactsJson(contacts, *ground->forces, ground->mass)
                                    : FormatContactsCsv(contacts));
}

void WriteResults(const std::string& file, const ConversionReport& report) {
  const GroundStudy& ground = *report.ground;
  WriteC3dWithResults(report.plan.input.recording.file, ground.results, ground.events, file);
}

void WriteGait(const std::string& file, const ConversionReport& report) {
  WriteGaitOf(file, {&report});
}

void WriteGaitOf(const std::string& file, const std::vector<const ConversionReport*>& reports) {
  const std::vector<std::string> names = NamesOfReports(reports);
  std::vector<GaitTrial> trials;
  for (std::size_t i = 0; i < reports.size(); ++i) {
    trials.push_back({names[i], &*reports[i]->ground->gait});
  }
  const bool is_json = fs::path(file).extension() == ".json";
  WriteFileAtomically(file, is_json ? FormatGaitJson(trials) : FormatGaitCsv(trials));
}

void WriteGrf(const std::string& file, const ConversionReport& report) {
  const auto& ground = report.ground;
  const PoseTrajectory& motion = report.result.trajectory;
  const ExternalLoads loads = {ground->forces.get(), &ground->contacts, motion.first_time,
                               motion.time(motion.num_frames() - 1)};
  const std::string name = fs::path(file).filename().string();
  WriteFileAtomically(file, OfFile(ForcesFile(report.plan.input),
                                   [&] { return Join(FormatExternalLoadsTable(loads, name)); }));
  const std::string beside = LoadsFile(file);
  if (!beside.empty()) WriteFileAtomically(beside, FormatExternalLoadsXml(loads, name));
}

void WriteJointForces(const std::string& file, const ConversionReport& report) {
  const JointForces& found = *report.ground->joint_forces;
  const std::string ending = fs::path(file).extension().string();
  if (ending == ".json") {
    WriteFileAtomically(file, FormatJointForcesJson(found));
  } else {
    WriteFileAtomically(
        file, ending == ".sto" ? FormatJointForcesSto(found) : FormatJointForcesCsv(found));
  }
}

void StudyPlates(ConversionReport* report) {
  const auto& forces = report->plan.forces;
  if (!forces || forces->plates.empty()) return;
  report->ground = StudyGround(*report, &report->warnings);
  const auto& borne = report->ground->mass;
  PersonValue& mass = report->plan.person.mass;
  if (!borne || !IsAssumed(mass) || !DoubtOfScale(borne, mass).empty()) return;
  mass = MassByForcePlates(borne->mass);
  auto& calibration = report->plan.calibration;
  if (!calibration) return;
  calibration->subject.mass = mass.value;
  report->plan.person.subject = std::make_shared<const Subject>(calibration->subject);
}

void StudyExports(const ExportFiles& files, ConversionReport* report) {
  if (!NeedForces(files)) return;
  auto ground = std::make_shared<GroundStudy>(*StudyGround(*report, &report->warnings));
  report->ground = ground;
  const auto table = files.find(kGrf);
  if (table != files.end()) CheckHasPlates(*ground->forces, report->plan.input);
  if (table != files.end() && ground->contacts.loads.empty()) {
    report->warnings.Add(
        fmt::format("{}: no force plate is loaded while the person is tracked: {} "
                    "has times and no forces",
                    ForcesFile(report->plan.input), table->second));
  }
  if (table != files.end() || files.count(kJointForces) > 0) {
    if (std::string unapplied = UnappliedSentence(*ground); !unapplied.empty()) {
      report->warnings.Add(std::move(unapplied));
    }
  }
  const auto joint_forces = files.find(kJointForces);
  if (joint_forces != files.end()) {
    ground->joint_forces = JointForcesOf(*report, *ground, HasDeviations(joint_forces->second));
    const Residuals residuals = MeasureResiduals(*ground->joint_forces);
    if (residuals.frames == 0 || !residuals.is_within) {
      report->warnings.Add(SentenceOf(residuals, *ground->joint_forces));
    }
  }
  if (files.count(kGait) > 0) {
    ground->gait = GaitOf(*report, *ground);
    if (std::string told = GaitSentence(*ground->gait); !told.empty()) {
      report->warnings.Add(std::move(told));
    }
  }
  const auto contacts = files.find(kContacts);
  if (files.count(kResults) > 0) {
    ground->results = C3dResultsOf(*report, *ground, &report->warnings);
  }
  if (files.count(kResults) > 0 || (contacts != files.end() && IsC3d(contacts->second))) {
    ground->events = AllEvents(SeenContacts(*report, *ground), *report);
    CheckC3dResults(report->plan.input.recording.file, ground->results, ground->events);
  }
  if (files.count(kGait) > 0 || files.count(kContacts) > 0 || files.count(kResults) > 0) {
    for (const std::string& note : ground->event_notes) report->warnings.Add(note);
  }
  CompareMass(*ground, report);
}

void ReadPlates(const ExportFiles& files, ConversionPlan* plan) {
  const Recording& recording = plan->input.recording;
  const bool has_feet = HasFeet(*plan->setup.model);
  const bool is_needed = NeedForces(files);
  if (is_needed && !has_feet) {
    throw Error(fmt::format(
        "{}: contacts, strides and joint forces need the feet of MMM's model, or segments calcn_l, "
        "calcn_r, toes_l and toes_r as OpenSim's persons have; {} lacks them",
        recording.file, plan->input.model_file));
  }
  for (const char* name : {kContacts, kResults}) {
    const auto copy = files.find(name);
    if (copy == files.end() || (name == kContacts && !IsC3d(copy->second))) continue;
    if (recording.format == "C3D") continue;
    throw Error(fmt::format("{}: is a copy of the recording with events, and {} is no C3D file; {}",
                            copy->second, recording.file,
                            name == kContacts ? "give a .json or .csv" : "take another export"));
  }
  if (files.count(kJointForces) > 0 && !(plan->setup.model->total_mass() > 0)) {
    throw Error(plan->input.model_file + ": has no masses, hence no dynamics");
  }
  if (!has_feet || plan->object) return;
  const bool needs_plates = files.count(kGrf) > 0 || files.count(kJointForces) > 0;
  try {
    plan->forces =
        std::make_shared<const RecordedForces>(GroundForces(plan->input, &plan->warnings));
  } catch (const Error& error) {
    if (is_needed || !plan->input.forces_file.empty()) throw;
    plan->warnings.Add(fmt::format("the force plates can't be read: {}", error.what()));
  }
  if (!needs_plates) return;
  CheckHasPlates(*plan->forces, plan->input);
  CheckHasForces(*plan->forces, plan->input, &plan->warnings);
}

void NameOutputs(const ExportFiles& files, OutputPlan* plan) {
  for (const auto& [name, file] : files) {
    plan->Write(file);
    if (name == kGrf) plan->WriteBeside(LoadsFile(file), kExternalLoadsBegin);
  }
}

}  // namespace mmm_converter
