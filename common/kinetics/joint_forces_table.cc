// SPDX-License-Identifier: MIT
#include "common/kinetics/joint_forces_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "common/io/tables/column_names.h"
#include "common/io/tables/table_rows.h"
#include "common/io/xml/xml_text.h"
#include "common/kinetics/inverse_dynamics.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Eigen::Index;

constexpr int kDecimals = 6;  // of N and N m
constexpr const char* kComponents[] = {"fx", "fy", "fz", "mx", "my", "mz"};

// What OpenSim's own walk has (subject01_walk1, gait2354) [N].
constexpr double kReferenceRms = 53;
constexpr double kReferencePeak = 137;  // of one direction
constexpr double kReferenceExternal = 925;

// What OpenSim calls acceptable after its residual reduction [N, N m].
constexpr double kReducedForcePeak = 25, kReducedForceRms = 15;
constexpr double kReducedMomentPeak = 75, kReducedMomentRms = 50;

std::vector<std::string> NamesWith(const JointForces& found, const char* of_moments,
                                   const char* of_forces) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < found.names.size(); ++i) {
    names.push_back(found.names[i] + (found.is_moment[i] ? of_moments : of_forces));
  }
  return ColumnNames(names);
}

/// Numbers of JSON.
std::string Rounded(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : "null";
}

std::string JsonOf(const ResidualSize& size, bool is_moment, double mass) {
  const double share = is_moment ? mass : mass * kStandardGravity;
  return fmt::format(R"({{"rms_{0}": {2}, "peak_{0}": {3}, "rms_{1}": {4}, "peak_{1}": {5}}})",
                     is_moment ? "Nm" : "N", is_moment ? "Nm_per_kg" : "of_body_weight",
                     Rounded(size.rms), Rounded(size.peak), Rounded(size.rms / share),
                     Rounded(size.peak / share));
}

std::string JsonOfResiduals(const JointForces& found) {
  const Residuals all = MeasureResiduals(found);
  if (all.frames == 0) return "null";
  std::vector<std::string> components;
  for (std::size_t i = 0; i < all.components.size(); ++i) {
    components.push_back(
        fmt::format("\"{}\": {}", kComponents[i], JsonOf(all.components[i], i >= 3, found.mass)));
  }
  return fmt::format(
      R"({{
    "frames": {}, "external_peak_N": {},
    "force": {},
    "moment": {},
    {},
    "limits": {{"source": "Hicks et al. 2015", "peak_force_N": {}, "peak_moment_Nm": {}}},
    "limits_after_residual_reduction": {{"source": "OpenSim", "peak_force_N": {}, "rms_force_N": {}, "peak_moment_Nm": {}, "rms_moment_Nm": {}}},
    "reference": {{"source": "OpenSim's subject01_walk1", "rms_force_N": {}, "peak_force_N": {}, "external_peak_N": {}}},
    "verdict": "{}"
  }})",
      all.frames, Rounded(all.external), JsonOf(all.force, false, found.mass),
      JsonOf(all.moment, true, found.mass), fmt::join(components, ",\n    "),
      Rounded(all.most_force), Rounded(all.most_moment), kReducedForcePeak, kReducedForceRms,
      kReducedMomentPeak, kReducedMomentRms, kReferenceRms, kReferencePeak, kReferenceExternal,
      all.is_within ? "within limits" : "beyond limits");
}

/// The extremes of a row that are known, per kg.
std::string JsonOfLeg(const JointForces& found, std::size_t i) {
  int frames = 0;
  Index largest = -1, smallest = -1;
  const auto row = found.forces.row(static_cast<Index>(i));
  for (Index k = 0; k < row.size(); ++k) {
    if (!std::isfinite(row[k])) continue;
    ++frames;
    if (largest < 0 || row[k] > row[largest]) largest = k;
    if (smallest < 0 || row[k] < row[smallest]) smallest = k;
  }
  const auto value = [&](Index k) { return Rounded(k < 0 ? kNaN : row[k] / found.mass); };
  const auto deviation = [&](Index k) {
    return Rounded(k < 0 || found.deviations.size() == 0
                       ? kNaN
                       : found.deviations(static_cast<Index>(i), k) / found.mass);
  };
  const auto time = [&](Index k) {
    return Rounded(k < 0 ? kNaN : found.time(static_cast<int>(k)));
  };
  return fmt::format(
      R"({{"name": "{}", "unit": "{}", "known_frames": {}, "largest": {}, "largest_at_s": {}, )"
      R"("largest_deviation": {}, "smallest": {}, "smallest_at_s": {}, "smallest_deviation": {}}})",
      PlainCell(OneWord(found.names[i])), found.is_moment[i] ? "N m/kg" : "N/kg", frames,
      value(largest), time(largest), deviation(largest), value(smallest), time(smallest),
      deviation(smallest));
}

}  // namespace

TextPieces FormatJointForcesSto(const JointForces& found) {
  const TableRows rows = RowsWithValues(found.forces);
  const std::string header = fmt::format(
      "Inverse Dynamics Generalized Forces\nversion=1\nnRows={}\nnColumns={}\ninDegrees=no\n"
      "endheader\ntime\t{}\n",
      rows.count(), found.names.size() + 1, fmt::join(NamesWith(found, "_moment", "_force"), "\t"));
  return TableText(header, rows, [&found](int k, std::string* out) {
    AppendDecimal(found.time(k), kSecondDecimals, out);
    AppendCells(found.forces.col(k), '\t', kDecimals, "nan", out);
  });
}

TextPieces FormatJointForcesCsv(const JointForces& found) {
  const std::vector<std::string> names = CsvColumnNames(NamesWith(found, "_Nm", "_N"));
  std::string header = fmt::format("time_s,{}", fmt::join(names, ","));
  const bool has_deviations = found.deviations.size() > 0;
  if (has_deviations) header += fmt::format(",sd_{}", fmt::join(names, ",sd_"));
  for (std::size_t i = 0; i < std::size(kComponents); ++i) {
    header += fmt::format(",residual_{}_{}", kComponents[i], i < 3 ? "N" : "Nm");
  }
  return TableText(header + '\n', {0, found.num_frames()},
                   [&found, has_deviations](int k, std::string* out) {
                     AppendDecimal(found.time(k), kSecondDecimals, out);
                     AppendCsvCells(found.forces.col(k), kDecimals, out);
                     if (has_deviations) AppendCsvCells(found.deviations.col(k), kDecimals, out);
                     AppendCsvCells(found.residuals.col(k), kDecimals, out);
                   });
}

std::string FormatJointForcesJson(const JointForces& found) {
  std::vector<std::string> legs;
  for (std::size_t i = 0; i < found.names.size(); ++i) {
    if (found.is_of_leg[i]) legs.push_back(JsonOfLeg(found, i));
  }
  return fmt::format(
      "{{\n  \"mass_kg\": {},\n  \"low_pass_Hz\": {},\n  \"unmeasured_frames\": {},\n  "
      "\"residuals\": {},\n  \"legs\": "
      "[\n    {}\n  ]\n}}\n",
      Rounded(found.mass), Rounded(found.cutoff), found.unmeasured_frames, JsonOfResiduals(found),
      fmt::join(legs, ",\n    "));
}

std::string SentenceOf(const Residuals& all, const JointForces& found) {
  if (all.frames == 0) {
    return "no frame has both feet on force plates or in the air, so that nothing tells whether "
           "motion, masses and forces fit together";
  }
  return fmt::format(
      "motion, masses and plates differ by {:.0f} N rms and {:.0f} N at most ({:.1f} % of the body "
      "weight), and by {:.0f} N m at most; to be within {:.0f} N and {:.0f} N m (Hicks et al. "
      "2015)",
      all.force.rms, all.force.peak, 100 * all.force.peak / (found.mass * kStandardGravity),
      all.moment.peak, all.most_force, all.most_moment);
}

}  // namespace mmm_converter
