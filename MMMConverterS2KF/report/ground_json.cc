// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/ground_json.h"

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/report/drawn_frames.h"
#include "MMMConverterS2KF/report/gait_json.h"
#include "MMMConverterS2KF/report/packed_array.h"
#include "common/kinetics/joint_forces_table.h"
#include "common/pipeline/ground_study.h"
#include "common/support/error.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr int kMillimetreDecimals = 4;  // of metres

/// Columns of samples at the drawn frames; NaN: the plate has no sample then, or bears nobody.
Eigen::Matrix3Xd AtFrames(const Eigen::Matrix3Xd& samples, const PlateForces& plate,
                          const RecordedForces& forces, const MarkerSequence& markers) {
  const DrawnFrames drawn(markers.num_frames());
  Eigen::Matrix3Xd at = Eigen::Matrix3Xd::Constant(3, drawn.count(), kNaN);
  for (int i = 0; i < drawn.count(); ++i) {
    const double time = markers.time(drawn.frame(i));
    const auto sample = std::lround((time - forces.first_time) * forces.rate);
    for (const LoadInterval& load : plate.loads) {
      if (load.begin <= sample && sample < load.end) at.col(i) = samples.col(sample);
    }
  }
  return at;
}

Json PlateJson(std::size_t index, const GroundStudy& ground, const MarkerSequence& markers) {
  const RecordedForces& forces = *ground.forces;
  const PlateForces& one = forces.plates[index];
  Json loads = Json::array();
  for (const PlateLoad& load : ground.contacts.loads) {
    if (load.plate != index) continue;
    loads.push_back({{"begin_s", Number(load.begin)},
                     {"end_s", Number(load.end)},
                     {"foot", Name(load.bearer)},
                     {"part_of_foot", load.is_part_of_foot}});
  }
  Json corners = nullptr;  // of a file of forces alone
  if (one.plate.half_size.minCoeff() > 0 && one.plate.corners.allFinite()) {
    corners = Json::array();
    for (const double value : one.plate.corners.reshaped()) {
      corners.push_back(Number(value, kMillimetreDecimals));
    }
  }
  return {{"number", one.plate.number},
          {"corners", corners},
          {"loads", loads},
          // A frame's components beside each other.
          {"force", ToJson(PackQuantised(AtFrames(one.force, one, forces, markers)))},
          {"pressure", ToJson(PackQuantised(AtFrames(one.cop, one, forces, markers)))}};
}

Json PlatesJson(const GroundStudy& ground, const MarkerSequence& markers) {
  Json plates = Json::array();
  for (std::size_t i = 0; i < ground.forces->plates.size(); ++i) {
    plates.push_back(PlateJson(i, ground, markers));
  }
  return plates;
}

Json StudyJson(const ConversionReport& report) {
  Warnings warnings;
  const auto ground = std::make_shared<GroundStudy>(*StudyGround(report, &warnings));
  const bool has_masses = report.plan.setup.model->total_mass() > 0;
  if (!ground->forces->plates.empty() && has_masses) {
    if (!ground->joint_forces) ground->joint_forces = JointForcesOf(report, *ground, false);
    const std::string mass = MassSentence(report, *ground);
    if (!mass.empty()) warnings.Add(mass);
    const std::string unapplied = UnappliedSentence(*ground);
    if (!unapplied.empty()) warnings.Add(unapplied);
    warnings.Add(SentenceOf(MeasureResiduals(*ground->joint_forces), *ground->joint_forces));
  }
  for (const std::string& doubt : ground->doubts) warnings.Add(doubt);
  const Json gait = GaitPageJson(report, *ground);
  if (!gait.is_null()) {
    Warnings of_events;
    for (const std::string& note : ground->event_notes) of_events.Add(note);
    warnings.AppendNew(of_events);
    const std::string deviations = DeviationSentence(ground->steps);
    if (!deviations.empty()) warnings.Add(deviations);
  }
  if (ground->forces->plates.empty() && gait.is_null()) return nullptr;
  const double mass = KnownMass(report, *ground);
  return {{"mass_kg", mass > 0 ? Number(mass) : Json(nullptr)},
          {"body_weight_n", mass > 0 ? Number(mass * kStandardGravity) : Json(nullptr)},
          {"plates", PlatesJson(*ground, report.plan.input.recording.markers)},
          {"gait", gait},
          {"notes", warnings.texts()}};
}

}  // namespace

Json StancesJson(const FootContacts& contacts) {
  Json stances = Json::array();
  for (const FootContact& one : contacts.contacts) {
    stances.push_back({{"foot", Name(one.side)},
                       {"begin_s", Number(one.begin.value_or(kNaN))},
                       {"end_s", Number(one.end.value_or(kNaN))}});
  }
  return stances;
}

Json GroundJson(const ConversionReport& report) {
  if (!HasFeet(*report.plan.setup.model)) return nullptr;
  try {
    return StudyJson(report);
  } catch (const Error& error) {  // the recording may be elsewhere by now: the page goes without
    return {{"plates", Json::array()}, {"gait", nullptr}, {"notes", {error.what()}}};
  }
}

}  // namespace mmm_converter
