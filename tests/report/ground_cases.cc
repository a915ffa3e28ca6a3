// SPDX-License-Identifier: MIT
#include "tests/report/ground_cases.h"

#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/report/packed_array.h"
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
  for (const char* name :
       {"stride_time_s", "cadence_steps_per_min", "stride_length_m", "speed_m_per_s",
        "foot_off_percent", "step_time_s", "step_length_m", "step_width_m"}) {
    summary[name] = {{"mean", mean}, {"sd", nullptr}, {"strides", 1}};
  }
  return summary;
}

Json CycleCase(const char* joint, const char* what, const char* unit) {
  Json mean = Json::array(), sd = Json::array();
  for (int percent = 0; percent <= 100; ++percent) {
    mean.push_back(percent);
    sd.push_back(percent < 50 ? Json(2) : Json(nullptr));
  }
  return {{"joint", joint}, {"side", "left"}, {"what", what}, {"unit", unit},
          {"strides", 2},   {"mean", mean},   {"sd", sd},     {"uncertainty", sd}};
}

}  // namespace

Json GroundCase(int frames) {
  const Json gait = {{"left_out", 1},
                     {"summary", {{"left", SummaryCase(1.25)}, {"right", SummaryCase(60)}}},
                     {"cycles",
                      {CycleCase("ground", "vertical force", "body weights"),
                       CycleCase("knee", "flexion", "°"), CycleCase("elbow", "flexion", "°")}}};
  return {{"mass_kg", kWeight / kStandardGravity},
          {"body_weight_n", kWeight},
          {"plates",
           {PlateCase(1, "left", frames, 0, frames / 2),
            PlateCase(2, "right", frames, frames / 2, frames)}},
          {"gait", gait},
          {"notes", {kHostileText}}};
}

}  // namespace mmm_converter::testing
