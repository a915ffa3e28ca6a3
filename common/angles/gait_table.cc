// SPDX-License-Identifier: MIT
#include "common/angles/gait_table.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "common/angles/normal_bands.h"
#include "common/io/tables/column_names.h"
#include "common/io/xml/xml_text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr int kDecimals = 6;

std::string Number(double value, const char* nothing) {
  if (!std::isfinite(value)) return nothing;
  std::string text;
  AppendDecimal(value, kDecimals, &text);
  return text;
}

std::string Json(double value) { return Number(value, "null"); }

/// A figure of strides, by the name that it has in files.
struct StrideFigure {
  const char* name;
  double (*of)(const Stride& stride);
};

constexpr StrideFigure kFigures[] = {
    {"stride_time_s", [](const Stride& one) { return one.time(); }},
    {"cadence_steps_per_min", [](const Stride& one) { return one.cadence(); }},
    {"stride_length_m", [](const Stride& one) { return one.length; }},
    {"speed_m_per_s", [](const Stride& one) { return one.speed(); }},
    {"foot_off_percent", [](const Stride& one) { return kPercent * one.foot_off; }},
    {"double_support_percent", [](const Stride& one) { return kPercent * one.double_support; }},
    {"step_time_s", [](const Stride& one) { return one.step_time; }},
    {"step_length_m", [](const Stride& one) { return one.step_length; }},
    {"step_width_m", [](const Stride& one) { return one.step_width; }}};

std::string StrideJson(const Stride& stride) {
  std::string text = fmt::format(
      R"({{"side": "{}", "begin_s": {}, "end_s": {}, "stride_time_deviation_s": {})",
      Name(stride.side), Json(stride.begin), Json(stride.end), Json(stride.time_deviation));
  for (const StrideFigure& figure : kFigures) {
    text += fmt::format(R"(, "{}": {})", figure.name, Json(figure.of(stride)));
  }
  text += fmt::format(
      R"(, "foot_off_deviation_percent": {}, "double_support_deviation_percent": {})",
      Json(kPercent * stride.foot_off_deviation), Json(kPercent * stride.double_support_deviation));
  return text + "}";
}

double MeanOf(const StrideFigure& figure, Side side, const std::vector<Stride>& strides) {
  double sum = 0, count = 0;
  for (const Stride& one : strides) {
    if (one.side != side || !std::isfinite(figure.of(one))) continue;
    sum += figure.of(one);
    ++count;
  }
  return sum / count;
}

/// By how much the right foot's means are larger than the left foot's, in percent of their mean:
/// the symmetry index (Robinson et al. 1987).
std::string SymmetryJson(const std::vector<Stride>& strides) {
  std::string text;
  for (const StrideFigure& figure : kFigures) {
    const double left = MeanOf(figure, Side::kLeft, strides);
    const double right = MeanOf(figure, Side::kRight, strides);
    text += fmt::format(R"({}"{}": {})", text.empty() ? "" : ", ", figure.name,
                        Json(2 * kPercent * (right - left) / (left + right)));
  }
  return fmt::format(R"("symmetry_index_percent": {{{}}})", text);
}

/// Mean and standard deviation of each figure among a foot's strides.
std::string SummaryJson(Side side, const std::vector<Stride>& strides) {
  std::string text;
  for (const StrideFigure& figure : kFigures) {
    std::vector<double> values;
    for (const Stride& one : strides) {
      if (one.side == side && std::isfinite(figure.of(one))) values.push_back(figure.of(one));
    }
    const auto count = static_cast<double>(values.size());
    double mean = 0, squares = 0;
    for (const double value : values) mean += value / count;
    for (const double value : values) squares += (value - mean) * (value - mean);
    text += fmt::format(R"({}"{}": {{"mean": {}, "sd": {}, "strides": {}}})",
                        text.empty() ? "" : ", ", figure.name, values.empty() ? "null" : Json(mean),
                        values.size() < 2 ? "null" : Json(std::sqrt(squares / (count - 1))),
                        values.size());
  }
  return fmt::format(R"("{}": {{{}}})", Name(side), text);
}

std::string ListJson(const std::array<double, GaitCycle::kSamples>& values, double unit) {
  std::vector<std::string> texts;
  texts.reserve(values.size());
  for (const double value : values) texts.push_back(Json(unit * value));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

/// Angles of the middle of the body are as the side of the strides sees them.
double OwnSign(const GaitCycle& cycle) {
  return OwnSideSign(cycle.angle.joint, cycle.angle.motion, cycle.side);
}

std::string ForceJson(const GaitCycle& one) {
  return fmt::format(
      R"({{"joint": "{}", "side": "{}", "what": "{}", "unit": "{}", "strides": {}, "mean": {}, "sd": {}}})",
      one.angle.joint, Name(one.side), one.angle.motion, ForceUnitOf(one.angle.motion), one.strides,
      ListJson(one.mean, 1), ListJson(one.deviation, 1));
}

std::string WorkJson(const JointWork& one) {
  return fmt::format(
      R"({{"joint": "{}", "side": "{}", "generated_J_per_kg": {}, "absorbed_J_per_kg": {}, "strides": {}}})",
      one.joint, one.side, Json(one.generated), Json(one.absorbed), one.strides);
}

/// sign: of the mean.
void AppendRows(const std::string& trial, const GaitCycle& cycle, const char* unit, double scale,
                double sign, std::string* text) {
  for (int i = 0; i < GaitCycle::kSamples; ++i) {
    *text +=
        fmt::format("{},{},{},{},{},{},{},{},{},{}\n", trial, cycle.angle.joint, Name(cycle.side),
                    cycle.angle.motion, unit, i, Number(sign * scale * cycle.mean[i], ""),
                    Number(scale * cycle.deviation[i], ""),
                    Number(scale * cycle.uncertainty[i], ""), cycle.strides);
  }
}

std::string TrialJson(const GaitTrial& trial) {
  const Gait& gait = *trial.gait;
  std::vector<std::string> strides, cycles, forces, work;
  for (const Stride& one : gait.strides) strides.push_back(StrideJson(one));
  for (const GaitCycle& one : gait.cycles) {
    cycles.push_back(fmt::format(
        R"({{"joint": "{}", "side": "{}", "angle": "{}", "strides": {}, "mean_degrees": {}, "sd_degrees": {}, "uncertainty_degrees": {}}})",
        one.angle.joint, Name(one.side), one.angle.motion, one.strides,
        ListJson(one.mean, OwnSign(one) * kDegrees), ListJson(one.deviation, kDegrees),
        ListJson(one.uncertainty, kDegrees)));
  }
  for (const GaitCycle& one : gait.forces) forces.push_back(ForceJson(one));
  for (const JointWork& one : gait.work) work.push_back(WorkJson(one));
  return fmt::format(
      "{{\n  \"trial\": {},\n  \"kind\": \"{}\",\n  \"strides_left_out\": {},\n  "
      "\"strides_over_turns\": {},\n  \"summary\": {{{}, {}, {}}},\n  \"work\": [{}],\n  "
      "\"strides\": [\n    {}\n  ],\n  \"cycles\": [\n    {}\n  ],\n  \"forces\": [\n    {}\n  "
      "]\n}}",
      '"' + PlainCell(trial.name) + '"', Name(gait.kind), gait.left_out, gait.turns,
      SummaryJson(Side::kLeft, gait.strides), SummaryJson(Side::kRight, gait.strides),
      SymmetryJson(gait.strides), fmt::join(work, ", "), fmt::join(strides, ",\n    "),
      fmt::join(cycles, ",\n    "), fmt::join(forces, ",\n    "));
}

}  // namespace

const char* ForceUnitOf(std::string_view motion) {
  if (motion.ends_with("force")) return "body weights";
  if (motion == "EMG") return "mV";
  return motion == "power" ? "W/kg" : "N m/kg";
}

std::string FormatGaitCsv(const std::vector<GaitTrial>& trials) {
  std::string text = "trial,joint,side,angle,unit,percent,mean,sd,uncertainty,strides\n";
  for (const GaitTrial& trial : trials) {
    const std::string name = PlainCell(trial.name);
    for (const GaitCycle& one : trial.gait->cycles)
      AppendRows(name, one, "degrees", kDegrees, OwnSign(one), &text);
    for (const GaitCycle& one : trial.gait->forces) {
      AppendRows(name, one, ForceUnitOf(one.angle.motion), 1, 1, &text);
    }
  }
  return text;
}

std::string FormatGaitJson(const std::vector<GaitTrial>& trials) {
  if (trials.size() == 1) return TrialJson(trials.front()) + '\n';
  std::vector<std::string> texts;
  for (const GaitTrial& one : trials) texts.push_back(TrialJson(one));
  return fmt::format("{{\"trials\": [\n{}\n]}}\n", fmt::join(texts, ",\n"));
}

}  // namespace mmm_converter
