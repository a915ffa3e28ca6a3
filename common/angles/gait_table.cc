// SPDX-License-Identifier: MIT
#include "common/angles/gait_table.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "common/io/xml/xml_text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr double kPercent = 100;
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

/// By how much the left foot's means are larger than the right foot's, in percent of both.
std::string SymmetryJson(const std::vector<Stride>& strides) {
  std::string text;
  for (const StrideFigure& figure : kFigures) {
    const double left = MeanOf(figure, Side::kLeft, strides);
    const double right = MeanOf(figure, Side::kRight, strides);
    text += fmt::format(R"({}"{}": {})", text.empty() ? "" : ", ", figure.name,
                        Json(2 * kPercent * (left - right) / (left + right)));
  }
  return fmt::format(R"("left_right_difference_percent": {{{}}})", text);
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

std::string ListJson(const std::array<double, GaitCycle::kSamples>& angles) {
  std::vector<std::string> texts;
  texts.reserve(angles.size());
  for (const double angle : angles) texts.push_back(Json(kDegrees * angle));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

}  // namespace

std::string FormatGaitCsv(const Gait& gait) {
  std::string text =
      "joint,side,angle,percent,mean_degrees,sd_degrees,uncertainty_degrees,strides\n";
  for (const GaitCycle& cycle : gait.cycles) {
    for (int i = 0; i < GaitCycle::kSamples; ++i) {
      text += fmt::format("{},{},{},{},{},{},{},{}\n", cycle.angle.joint, Name(cycle.side),
                          cycle.angle.motion, i, Number(kDegrees * cycle.mean[i], ""),
                          Number(kDegrees * cycle.deviation[i], ""),
                          Number(kDegrees * cycle.uncertainty[i], ""), cycle.strides);
    }
  }
  return text;
}

std::string FormatGaitJson(const Gait& gait) {
  std::vector<std::string> strides, cycles;
  for (const Stride& one : gait.strides) strides.push_back(StrideJson(one));
  for (const GaitCycle& one : gait.cycles) {
    cycles.push_back(fmt::format(
        R"({{"joint": "{}", "side": "{}", "angle": "{}", "strides": {}, "mean_degrees": {}, "sd_degrees": {}, "uncertainty_degrees": {}}})",
        one.angle.joint, Name(one.side), one.angle.motion, one.strides, ListJson(one.mean),
        ListJson(one.deviation), ListJson(one.uncertainty)));
  }
  return fmt::format(
      "{{\n  \"kind\": \"{}\",\n  \"strides_left_out\": {},\n  \"strides_over_turns\": {},\n  "
      "\"summary\": {{{}, {}, {}}},\n  \"strides\": [\n    {}\n  "
      "],\n  \"cycles\": [\n    {}\n  "
      "]\n}}\n",
      Name(gait.kind), gait.left_out, gait.turns, SummaryJson(Side::kLeft, gait.strides),
      SummaryJson(Side::kRight, gait.strides), SymmetryJson(gait.strides),
      fmt::join(strides, ",\n    "), fmt::join(cycles, ",\n    "));
}

}  // namespace mmm_converter
