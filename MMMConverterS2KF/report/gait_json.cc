// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/gait_json.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "common/angles/anatomical_angles.h"
#include "common/angles/gait_table.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

Json Samples(const std::array<double, GaitCycle::kSamples>& values, double unit, int decimals) {
  Json out = Json::array();
  for (const double value : values) out.push_back(Number(unit * value, decimals));
  return out;
}

Json CycleJson(const GaitCycle& cycle, const char* unit, double scale, int decimals) {
  return {{"joint", cycle.angle.joint},
          {"side", Name(cycle.side)},
          {"what", cycle.angle.motion},
          {"unit", unit},
          {"strides", cycle.strides},
          {"mean", Samples(cycle.mean, scale, decimals)},
          {"sd", Samples(cycle.deviation, scale, decimals)},
          {"uncertainty", Samples(cycle.uncertainty, scale, decimals)}};
}

}  // namespace

Json GaitPageJson(const ConversionReport& report, const GroundStudy& ground) {
  if (!HasAnatomy(*report.plan.setup.model)) return nullptr;
  const Gait gait = ground.gait ? *ground.gait : GaitOf(report, ground);
  if (gait.strides.empty()) return nullptr;
  Json cycles = Json::array();
  for (const GaitCycle& one : ForceCyclesOf(report, ground, gait)) {
    const bool is_force = std::string_view(one.angle.motion).ends_with("force");
    cycles.push_back(CycleJson(one, is_force ? "body weights" : "N m/kg", 1, 3));
  }
  for (const GaitCycle& one : gait.cycles) cycles.push_back(CycleJson(one, "°", kDegrees, 2));
  const Json told = ParseJson(FormatGaitJson(gait));
  return {{"left_out", gait.left_out}, {"summary", told["summary"]}, {"cycles", cycles}};
}

}  // namespace mmm_converter
