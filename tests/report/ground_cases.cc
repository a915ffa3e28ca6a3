// SPDX-License-Identifier: MIT
#include "tests/report/ground_cases.h"

#include <nlohmann/json.hpp>
#include <string_view>

#include "MMMConverterS2KF/report/packed_array.h"
#include "common/kinetics/inverse_dynamics.h"
#include "common/support/units.h"

namespace mmm_converter::testing {
namespace {

constexpr double kWeight = 700;  // [N]

Json PlateCase(int number, const char* foot, int frames, int begin, int end) {
  Eigen::Matrix3Xd force = Eigen::Matrix3Xd::Constant(3, frames, kNaN);
  Eigen::Matrix3Xd pressure = force;
  for (int k = begin; k < end; ++k) {
    force.col(k) << 10, 0, number * kWeight;
    pressure.col(k) << number, 0.1, 0;
  }
  const double x = number;
  return {{"number", number},
          {"corners", {x - 0.3, 0.2, 0, x + 0.3, 0.2, 0, x + 0.3, -0.2, 0, x - 0.3, -0.2, 0}},
          {"loads", {{{"begin_s", 0}, {"end_s", 100}, {"foot", foot}}}},
          {"force", ToJson(PackQuantised(force))},
          {"pressure", ToJson(PackQuantised(pressure))}};
}

Json SummaryCase(double mean) {
  Json summary;
  for (const char* name : {"stride_time_s", "cadence_steps_per_min", "stride_length_m",
                           "speed_m_per_s", "foot_off_percent", "step_time_s", "step_length_m",
                           "step_width_m", "double_support_percent"}) {
    summary[name] = {{"mean", mean}, {"sd", nullptr}, {"strides", 1}};
  }
  return summary;
}

// The mean is the percent; the left foot's strides are a degree apart.
Json CycleCase(const char* joint, const char* side, const char* what, const char* unit,
               double uncertainty = 2) {
  Json mean = Json::array(), sd = Json::array(), doubt = Json::array();
  Eigen::MatrixXd singles(51, 2);
  for (int percent = 0; percent <= 100; ++percent) {
    mean.push_back(percent);
    sd.push_back(percent < 50 ? Json(2) : Json(nullptr));
    doubt.push_back(uncertainty);
    if (percent % 2 == 0) singles.row(percent / 2) << percent - 0.5, percent + 0.5;
  }
  Json cycle = {{"joint", joint}, {"side", side}, {"what", what}, {"unit", unit},
                {"strides", 2},   {"mean", mean}, {"sd", sd},     {"uncertainty", doubt}};
  if (std::string_view(unit) == "°") cycle["singles"] = ToJson(PackQuantised(singles));
  return cycle;
}

Json CyclesCase() {
  Json cycles = Json::array();
  for (const char* side : {"left", "right"}) {
    cycles.push_back(CycleCase("ground", side, "vertical force", "body weights"));
    cycles.push_back(CycleCase("TA", side, "EMG", "mV"));
    cycles.push_back(CycleCase("knee", side, "flexion", "°"));
    cycles.push_back(CycleCase("hip", side, "internal rotation", "°", 17));
    cycles.push_back(CycleCase("foot", side, "progression", "°"));
    cycles.push_back(CycleCase("elbow", side, "flexion", "°"));
    cycles.push_back(CycleCase("wrist", side, "flexion", "°", 40));
  }
  return cycles;
}

Json NormalCase() {
  Json mean = Json::array(), sd = Json::array();
  for (int percent = 0; percent <= 100; ++percent) {
    mean.push_back(50);
    sd.push_back(5);
  }
  Json bands = Json::array();
  bands.push_back(
      {{"joint", "knee"}, {"what", "flexion"}, {"side", nullptr}, {"mean", mean}, {"sd", sd}});
  return {{"source", kHostileText}, {"bands", bands}};
}

// Nine scores of `score`.
Json ProfileCase(double score) {
  Json variables = Json::array();
  for (const char* joint :
       {"pelvis", "hip", "knee", "ankle", "pelvis", "hip", "pelvis", "hip", "foot"}) {
    variables.push_back(
        {{"mean", score}, {"sd", 1}, {"strides", 2}, {"joint", joint}, {"what", "flexion"}});
  }
  return {{"variables", variables}, {"score", {{"mean", score}, {"sd", nullptr}, {"strides", 1}}}};
}

}  // namespace

Json GroundCase(int frames) {
  const Json gait = {{"left_out", 1},
                     {"summary", {{"left", SummaryCase(1.25)}, {"right", SummaryCase(60)}}},
                     {"cycles", CyclesCase()},
                     {"normal", NormalCase()},
                     {"profile", {{"left", ProfileCase(6)}, {"right", ProfileCase(8)}}}};
  return {{"mass_kg", kWeight / kStandardGravity},
          {"body_weight_n", kWeight},
          {"plates",
           {PlateCase(1, "left", frames, 0, frames / 2),
            PlateCase(2, "right", frames, frames / 2, frames)}},
          {"gait", gait},
          {"notes", {kHostileText}}};
}

Json PatientCase() {
  Json recordings = Json::array();
  recordings.push_back({{"file", "walk.c3d"},
                        {"motion", nullptr},
                        {"date", "2010-03-04"},
                        {"condition", kHostileText},
                        {"system", "Vicon"},
                        {"frames", 300},
                        {"rate_hz", 100},
                        {"verdict", "check"},
                        {"reasons", {kHostileText}}});
  return {{"name", kHostileText},
          {"height_m", {{"value", 1.72}, {"source", "given"}, {"deviation", 0.02}}},
          {"mass_kg", {{"value", 70}, {"source", "assumed"}, {"deviation", nullptr}}},
          {"recordings", recordings}};
}

}  // namespace mmm_converter::testing
