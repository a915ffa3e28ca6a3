// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/comparison_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "common/math/statistics.h"
#include "common/support/advice.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

// A figure in the unit that its name says.
struct Column {
  const char* heading;
  const char* unit;
  const char* name;  // in the CSV
  int decimals;
  double (*value)(const TrackingQuality&);
};

using Quality = TrackingQuality;

const Column kColumns[] = {
    {"mean", "mm", "mean_mm", 2, [](const Quality& q) { return kMillimetres * q.all.mean; }},
    {"p95", "mm", "p95_mm", 1, [](const Quality& q) { return kMillimetres * q.all.p95; }},
    {"max", "mm", "max_mm", 1, [](const Quality& q) { return kMillimetres * q.all.max; }},
    {"worst fr.", "mm", "worst_frame_mm", 1,
     [](const Quality& q) { return kMillimetres * q.all.worst_frame; }},
    {"hid. mean", "mm", "hidden_mean_mm", 1,
     [](const Quality& q) { return kMillimetres * q.hidden.mean; }},
    {"hid. p95", "mm", "hidden_p95_mm", 1,
     [](const Quality& q) { return kMillimetres * q.hidden.p95; }},
    {"hid. max", "mm", "hidden_max_mm", 1,
     [](const Quality& q) { return kMillimetres * q.hidden.max; }},
    {"conv.", "frames", "frames_to_converge", 0,
     [](const Quality& q) { return q.first_good.value_or(kNaN); }},
    {"lost", "frames", "frames_lost", 1, [](const Quality& q) { return q.lost_frames; }},
    {"jitter", "rad/s2", "jitter_rad_per_s2", 1, [](const Quality& q) { return q.jitter; }},
    {"step", "rad", "largest_step_rad", 2, [](const Quality& q) { return q.largest_step; }},
    {"at limit", "%", "limit_percent", 1,
     [](const Quality& q) { return kPercent * q.limit_share; }},
    {"median", "ms/fr.", "median_ms", 3,
     [](const Quality& q) { return kMilliseconds * q.median_seconds; }},
    {"p99", "ms/fr.", "p99_ms", 3, [](const Quality& q) { return kMilliseconds * q.p99_seconds; }},
    {"centres", "mm", "joint_center_error_mm", 1,
     [](const Quality& q) { return kMillimetres * q.joint_center_error; }},
    {"angles", "deg", "joint_angle_error_deg", 2,
     [](const Quality& q) { return kDegrees * q.joint_angle_error; }},
    {"in 1 sd", "%", "within_1_sd_percent", 0,
     [](const Quality& q) { return kPercent * q.ReliabilityAt(1); }},
    {"in 2 sd", "%", "within_2_sd_percent", 0,
     [](const Quality& q) { return kPercent * q.ReliabilityAt(2); }}};

std::string Cell(const Column& column, const Quality& quality) {
  const double value = column.value(quality);
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, column.decimals) : "";
}

// A contender's figures, for a line of the table.
struct TableLine {
  std::string name;
  Quality quality;
};

// Columns in which some line has a number.
std::vector<const Column*> UsedColumns(const std::vector<TableLine>& lines) {
  std::vector<const Column*> used;
  for (const Column& column : kColumns) {
    if (std::any_of(lines.begin(), lines.end(), [&](const TableLine& line) {
          return std::isfinite(column.value(line.quality));
        })) {
      used.push_back(&column);
    }
  }
  return used;
}

std::string FormatLines(const std::vector<TableLine>& lines, std::size_t name_width) {
  const std::vector<const Column*> columns = UsedColumns(lines);
  std::string text = fmt::format("  {:<{}}", "", name_width);
  std::string units;
  for (const Column* column : columns) {
    text += fmt::format(" {:>9}", column->heading);
    units += fmt::format(" {:>9}", column->unit);
  }
  text += fmt::format("\n  {:<{}}{}\n", "", name_width, units);
  for (const TableLine& line : lines) {
    text += fmt::format("  {:<{}}", line.name, name_width);
    for (const Column* column : columns) {
      const std::string cell = Cell(*column, line.quality);
      text += fmt::format(" {:>9}", cell.empty() ? "-" : cell);
    }
    text += '\n';
  }
  return text;
}

std::string DescribeHiding(const ComparisonOptions& options) {
  const Hiding& hiding = options.hiding;
  if (hiding.amount == 0) return "";
  const std::string runs =
      options.runs == 1 ? fmt::format("seed {}", options.seed)
                        : fmt::format("{} runs, seeds {} to {}", options.runs, options.seed,
                                      options.seed + static_cast<std::uint64_t>(options.runs) - 1);
  return hiding.model == HidingModel::kPaper
             ? fmt::format(", hiding with {:g} % a frame for {:g} frames ({})",
                           kPercent * hiding.amount, hiding.mean_frames, runs)
             : fmt::format(", {:g} % hidden throughout ({})", kPercent * hiding.amount, runs);
}

std::string FormatTrial(const Comparison& comparison, int trial, std::size_t name_width) {
  std::vector<TableLine> lines;
  for (const ComparisonRow& row : comparison.rows) {
    if (row.trial != trial || !row.failure.empty()) continue;
    lines.push_back({comparison.contenders[row.contender].name, row.quality});
  }
  if (lines.empty()) return "";
  const CommonGround& ground = comparison.grounds[trial];
  const MarkerSequence& markers = comparison.trials[trial].markers;
  const std::span optimum(ground.optimum.data(), static_cast<std::size_t>(ground.optimum.size()));
  return fmt::format(
             "{}: {} frames at {:g} Hz; {} markers and {} joints compared{}; optimum {:.2f} mm{}\n",
             comparison.trials[trial].name, markers.num_frames(), markers.rate(),
             ground.labels.size(), ground.joints.size(), DescribeHiding(comparison.options),
             kMillimetres * Mean(optimum),
             ground.optimum_every > 1 ? fmt::format(" (of one in {} frames)", ground.optimum_every)
                                      : "") +
         FormatLines(lines, name_width);
}

// Means over the recordings, of contenders that failed on none.
std::string FormatMeans(const Comparison& comparison, std::size_t name_width) {
  std::vector<TableLine> lines;
  for (std::size_t c = 0; c < comparison.contenders.size(); ++c) {
    std::vector<Quality> all;
    for (const ComparisonRow& row : comparison.rows) {
      if (row.contender == static_cast<int>(c) && row.failure.empty()) all.push_back(row.quality);
    }
    if (all.size() < comparison.trials.size()) continue;
    lines.push_back({comparison.contenders[c].name, Summarize(all)});
  }
  if (lines.empty() || comparison.trials.size() < 2) return "";
  return fmt::format("All {} recordings, each counting the same\n", comparison.trials.size()) +
         FormatLines(lines, name_width);
}

std::string CsvText(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

}  // namespace

std::string FormatComparisonTable(const Comparison& comparison) {
  std::size_t name_width = 0;
  for (const Contender& contender : comparison.contenders) {
    name_width = std::max(name_width, contender.name.size());
  }
  std::string text;
  for (std::size_t t = 0; t < comparison.trials.size(); ++t) {
    text += FormatTrial(comparison, static_cast<int>(t), name_width);
  }
  text += FormatMeans(comparison, name_width);
  for (const ComparisonRow& row : comparison.rows) {
    if (row.failure.empty()) continue;
    text += fmt::format("failed: {} on {}: {}\n", comparison.contenders[row.contender].name,
                        comparison.trials[row.trial].name, WithAdvice(row.failure, row.remedy));
  }
  return text;
}

std::string FormatComparisonCsv(const Comparison& comparison) {
  std::string text = "recording,configuration,failure,optimum_mm";
  for (const Column& column : kColumns) text += fmt::format(",{}", column.name);
  text += '\n';
  for (const ComparisonRow& row : comparison.rows) {
    text += fmt::format("{},{},{}", CsvText(comparison.trials[row.trial].name),
                        CsvText(comparison.contenders[row.contender].name),
                        CsvText(WithAdvice(row.failure, row.remedy)));
    const Eigen::VectorXd& optimum = comparison.grounds[row.trial].optimum;
    const double mean =
        kMillimetres * Mean({optimum.data(), static_cast<std::size_t>(optimum.size())});
    text += std::isfinite(mean) ? fmt::format(",{:.4f}", mean) : ",";
    for (const Column& column : kColumns) {
      const double value = row.failure.empty() ? column.value(row.quality) : kNaN;
      text += std::isfinite(value) ? fmt::format(",{:.4f}", value) : ",";
    }
    text += '\n';
  }
  return text;
}

}  // namespace mmm_converter
