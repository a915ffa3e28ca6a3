// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/ground_json.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string_view>

#include "MMMConverterS2KF/report/drawn_frames.h"
#include "MMMConverterS2KF/report/json.h"
#include "MMMConverterS2KF/report/packed_array.h"
#include "common/angles/gait_feet.h"
#include "common/angles/gait_table.h"
#include "common/angles/normal_bands.h"
#include "common/kinetics/joint_forces_table.h"
#include "common/motion/anatomical_angles.h"
#include "common/pipeline/conversion.h"
#include "common/pipeline/ground_study.h"
#include "common/study/coverage.h"
#include "common/support/error.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Samples = std::array<double, GaitCycle::kSamples>;

constexpr int kDrawnStrides = 30;  // of each foot and angle: more are one grey
constexpr int kDrawnSamples = 51;  // every second percent

Json SamplesJson(const Samples& values, double unit, int decimals) {
  Json out = Json::array();
  for (const double value : values) out.push_back(Number(unit * value, decimals));
  return out;
}

/// scale: to the unit, and to the side's own sign.
Json CycleJson(const GaitCycle& cycle, const char* unit, double scale, int decimals) {
  return {{"joint", cycle.angle.joint},
          {"side", Name(cycle.side)},
          {"what", cycle.angle.motion},
          {"unit", unit},
          {"strides", cycle.strides},
          {"mean", SamplesJson(cycle.mean, scale, decimals)},
          {"sd", SamplesJson(cycle.deviation, std::abs(scale), decimals)},
          {"uncertainty", SamplesJson(cycle.uncertainty, std::abs(scale), decimals)}};
}

/// Some single strides, evenly chosen, a column each.
Json SinglesJson(const std::vector<GaitCycle>& singles, double scale) {
  const int all = static_cast<int>(singles.size());
  const int count = std::min(all, kDrawnStrides);
  Eigen::MatrixXd columns(kDrawnSamples, count);
  for (int i = 0; i < count; ++i) {
    const GaitCycle& one = singles[static_cast<std::size_t>(i * all / count)];
    for (int k = 0; k < kDrawnSamples; ++k) columns(k, i) = scale * one.mean[2 * k];
  }
  return ToJson(PackQuantised(columns));
}

bool IsSame(const GaitCycle& a, const GaitCycle& b) {
  return a.side == b.side && std::string_view(a.angle.joint) == b.angle.joint &&
         std::string_view(a.angle.motion) == b.angle.motion;
}

/// The angles of each stride, and how the foot stands to its way.
std::vector<GaitCycle> SingleCycles(const ConversionReport& report, const GroundStudy& ground,
                                    const Gait& gait) {
  PoseTrajectory motion = report.result.trajectory;
  motion.standard_deviations.resize(0, 0);
  AnatomicalAngles angles = ShownAngles(report.plan.setup, motion);
  HideUnknown(report.plan.setup, report.plan.input.recording.markers, &angles);
  std::vector<GaitCycle> singles;
  for (const Stride& stride : gait.strides) {
    for (GaitCycle& one : CyclesOf(angles, {stride})) singles.push_back(one);
    singles.push_back(FootProgression(ground.feet, stride));
  }
  return singles;
}

std::vector<GaitCycle> ThoseOf(const GaitCycle& cycle, const std::vector<GaitCycle>& singles) {
  std::vector<GaitCycle> own;
  std::copy_if(singles.begin(), singles.end(), std::back_inserter(own),
               [&](const GaitCycle& one) { return IsSame(one, cycle); });
  return own;
}

/// Mean, deviation and number of what is known, as the summary of strides has figures.
Json FigureJson(const std::vector<double>& values) {
  double sum = 0, squares = 0, count = 0;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    sum += value;
    ++count;
  }
  for (const double value : values) {
    const double apart = value - sum / count;
    if (std::isfinite(apart)) squares += apart * apart;
  }
  return {{"mean", Number(sum / count, 3)},
          {"sd", count > 1 ? Number(std::sqrt(squares / (count - 1)), 3) : Json(nullptr)},
          {"strides", static_cast<int>(count)}};
}

Json BandsJson(const NormalBands& normal) {
  Json bands = Json::array();
  for (const NormalBand& one : normal.bands) {
    bands.push_back({{"joint", one.joint},
                     {"what", one.motion},
                     {"side", one.side ? Json(Name(*one.side)) : Json(nullptr)},
                     {"mean", SamplesJson(one.mean, 1, 2)},
                     {"sd", SamplesJson(one.deviation, 1, 2)}});
  }
  return {{"source", normal.source}, {"lacking", LackingAngles(normal)}, {"bands", bands}};
}

/// The Gait Variable Scores of each foot's strides, and their root mean square, the Gait Profile
/// Score. Null: a normal band is missing, or an angle of a stride.
Json ProfileJson(const std::vector<GaitCycle>& singles, const NormalBands& normal) {
  Json profile;
  for (const Side side : kSides) {
    std::vector<double> squares;
    Json scores = Json::array();
    for (const ProfileAngle& angle : kProfileAngles) {
      const NormalBand* band = normal.Find(angle.joint, angle.motion, side);
      if (band == nullptr) return nullptr;
      GaitCycle asked;
      asked.angle = {angle.joint, "", angle.motion};
      asked.side = side;
      std::vector<double> values;
      for (const GaitCycle& one : ThoseOf(asked, singles)) {
        values.push_back(VariableScore(one, *band));
      }
      if (scores.empty()) squares.assign(values.size(), 0);
      if (values.empty() || values.size() != squares.size()) return nullptr;
      for (std::size_t i = 0; i < values.size(); ++i) {
        squares[i] += values[i] * values[i] / kProfileAngles.size();
      }
      Json score = FigureJson(values);
      score["joint"] = angle.joint;
      score["what"] = angle.motion;
      scores.push_back(score);
    }
    for (double& one : squares) one = std::sqrt(one);
    profile[Name(side)] = {{"variables", scores}, {"score", FigureJson(squares)}};
  }
  return profile;
}

Json AngleCyclesJson(const Gait& gait, const std::vector<GaitCycle>& singles) {
  std::vector<GaitCycle> cycles = gait.cycles;
  for (const Side side : kSides) {
    GaitCycle foot;
    foot.angle = {"foot", Name(side), "progression"};
    foot.side = side;
    const std::vector<GaitCycle> own = ThoseOf(foot, singles);
    if (!own.empty()) cycles.push_back(MeanOf(own));
  }
  Json out = Json::array();
  for (const GaitCycle& one : cycles) {
    const double scale = kDegrees * OwnSideSign(one.angle.joint, one.angle.motion, one.side);
    out.push_back(CycleJson(one, "°", scale, 2));
    out.back()["singles"] = SinglesJson(ThoseOf(one, singles), scale);
  }
  return out;
}

/// What the page says of strides: figures of each foot, angles over the cycle and, where there are
/// plates, forces and moments. Null: there is no stride, or the model has no names for its angles.
Json GaitPageJson(const ConversionReport& report, const GroundStudy& ground) {
  if (!HasAnatomy(*report.plan.setup.model)) return nullptr;
  const Gait gait = ground.gait ? *ground.gait : GaitOf(report, ground);
  if (gait.strides.empty()) return nullptr;
  const std::vector<GaitCycle> singles = SingleCycles(report, ground, gait);
  Json cycles = AngleCyclesJson(gait, singles);
  for (const GaitCycle& one : gait.forces) {
    cycles.push_back(CycleJson(one, ForceUnitOf(one.angle.motion), 1, 3));
  }
  Json out = {{"condition", TextOrNull(report.plan.patient.condition)},
              {"left_out", gait.left_out},
              {"summary", ParseJson(FormatGaitJson({{"", &gait}}))["summary"]},
              {"cycles", cycles}};
  if (report.plan.normal) {
    out["normal"] = BandsJson(*report.plan.normal);
    out["profile"] = ProfileJson(singles, *report.plan.normal);
  }
  return out;
}

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
